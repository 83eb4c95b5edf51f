use super::*;
use crate::design::latin_hypercube;

/// A kink whose position depends on another input: the weight beyond what the wear flats carry.
fn kinked(x: &[f64]) -> f64 {
    3.0 + 2.0 * x[0] - x[1] + 8.0 * (x[0] - 0.3 * x[1] - 0.4).max(0.0) + 0.3 * x[2]
}

fn results(points: &[Vec<f64>], of: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    points.iter().map(|point| of(point)).collect()
}

#[test]
fn a_line_is_found_again_with_no_error() {
    let line = |x: &[f64]| 3.0 + 2.0 * x[0] - x[1] + 0.5 * x[2];
    let points = latin_hypercube(usual_points(3), 3, 2);
    let surrogate = Surrogate::new("torque", &points, &results(&points, line)).unwrap();
    // Rounding of a least-squares problem whose covariance has a condition of up to 1e8.
    assert!(surrogate.error < 1e-7, "{}", surrogate.error);
    for x in [[0.3, 0.6, 0.5], [-1.0, 2.0, 3.0]] {
        assert!((surrogate.predict(&x) - line(&x)).abs() < 1e-6);
    }
}

/// The error that is stated is that of new points, and as often as it states.
#[test]
fn the_error_of_points_left_out_is_that_of_new_points() {
    let points = latin_hypercube(48, 3, 3);
    let surrogate = Surrogate::new("torque", &points, &results(&points, kinked)).unwrap();
    let fresh = latin_hypercube(400, 3, 4);
    let errors: Vec<f64> = fresh.iter().map(|x| surrogate.predict(x) - kinked(x)).collect();
    let seen = (errors.iter().map(|error| error * error).sum::<f64>() / 400.0).sqrt();
    // An estimate from 48 points at a kink, which few of them see.
    assert!(
        (0.5..2.0).contains(&(surrogate.error / seen)),
        "{} {seen}",
        surrogate.error
    );
    let held = fresh
        .iter()
        .zip(&errors)
        .filter(|(x, error)| error.abs() <= crate::BAND * surrogate.deviation(x));
    // Nine of ten, or more: the band is nowhere narrower than the error of the points left out.
    assert!(held.count() >= 340);
}

/// A point that is left out is predicted as by a process that has never seen it, with the same lengths.
#[test]
fn leaving_out_is_fitting_without() {
    let points = latin_hypercube(24, 3, 5);
    let y = results(&points, kinked);
    let logarithms = [0.3, 0.5, 1.0, -6.0];
    let search = |points: &[Vec<f64>], y: &[f64]| {
        let terms = DMatrix::from_fn(
            points.len(),
            4,
            |k, term| if term == 0 { 1.0 } else { points[k][term - 1] },
        );
        let search = Search {
            seen: points,
            terms,
            y: DVector::from_row_slice(y),
        };
        let fitted = search.fit(&logarithms).unwrap().1;
        let left_out = search.left_out(&fitted);
        (fitted, left_out)
    };
    let (_, (errors, _)) = search(&points, &y);
    for k in [0, 7, 23] {
        let (mut others, mut of_others) = (points.clone(), y.clone());
        let (x, value) = (others.remove(k), of_others.remove(k));
        let (fitted, _) = search(&others, &of_others);
        let surrogate = Surrogate {
            scale: vec![[0.0, 1.0]; 3],
            points: others.len(),
            seen: others,
            fitted,
            error: 0.0,
            left_out: Vec::new(),
            range: [0.0; 2],
        };
        // Rounding.
        assert!((value - surrogate.predict(&x) - errors[k]).abs() < 1e-9, "{k}");
    }
}

/// A quadratic turns back at a kink.
#[test]
fn a_kink_is_followed_better_than_by_a_quadratic() {
    let points = latin_hypercube(48, 3, 3);
    let y = results(&points, kinked);
    let surrogate = Surrogate::new("torque", &points, &y).unwrap();
    let terms = |x: &[f64]| {
        let mut all = vec![1.0];
        all.extend(x);
        for i in 0..3 {
            all.extend((i..3).map(|j| x[i] * x[j]));
        }
        all
    };
    let rows: Vec<f64> = points.iter().flat_map(|x| terms(x)).collect();
    let matrix = DMatrix::from_row_slice(48, 10, &rows);
    let quadratic = matrix.svd(true, true).solve(&DVector::from_vec(y), 0.0).unwrap();
    let fresh = latin_hypercube(400, 3, 4);
    let error = |predict: &dyn Fn(&[f64]) -> f64| {
        (fresh.iter().map(|x| (predict(x) - kinked(x)).powi(2)).sum::<f64>() / 400.0).sqrt()
    };
    let of_process = error(&|x| surrogate.predict(x));
    let of_quadratic = error(&|x| terms(x).iter().zip(&quadratic).map(|(x, c)| x * c).sum());
    assert!(2.0 * of_process < of_quadratic, "{of_process} {of_quadratic}");
}

#[test]
fn errors_of_near_points_are_alike_and_never_below_what_was_left_out() {
    let points = latin_hypercube(48, 3, 3);
    let surrogate = Surrogate::new("torque", &points, &results(&points, kinked)).unwrap();
    let at = [vec![0.5, 0.5, 0.5], vec![0.52, 0.5, 0.5], vec![0.1, 0.9, 0.1]];
    let covariance = surrogate.error_covariance(&at);
    for k in 0..3 {
        assert!(covariance[(k, k)] >= 0.999_999 * surrogate.error.powi(2));
    }
    let correlation = |i: usize, j: usize| covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
    assert!(correlation(0, 1) > 0.7, "{}", correlation(0, 1));
    assert!(correlation(0, 2).abs() < 0.3, "{}", correlation(0, 2));
    assert!(covariance.cholesky().is_some());
    // A point far outside is known less.
    assert!(surrogate.deviation(&[3.0, 0.5, 0.5]) > 3.0 * surrogate.error);
}

#[test]
fn points_that_do_not_suffice_are_refused() {
    let points = latin_hypercube(7, 3, 2);
    let error = Surrogate::new("torque", &points, &[0.0; 7]).unwrap_err();
    assert!(
        error.to_string().contains("7 points for 4 coefficients: at least 8"),
        "{error}"
    );
    let mut flat = latin_hypercube(13, 3, 2);
    flat.iter_mut().for_each(|point| point[1] = 0.5);
    assert!(matches!(
        Surrogate::new("torque", &flat, &[0.0; 13]),
        Err(CalibrationError::PoorPoints { .. })
    ));
    // The same result everywhere is a line, too.
    let points = latin_hypercube(24, 3, 2);
    let surrogate = Surrogate::new("torque", &points, &[0.0; 24]).unwrap();
    assert_eq!((surrogate.predict(&[0.5; 3]), surrogate.error), (0.0, 0.0));
}
