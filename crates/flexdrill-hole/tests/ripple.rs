//! Ripples: the onset of two contacts, and the onset of a guide that lies on the wall.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_hole::{BitLaw, Gravity, Guide, Propagation, ripple_of_two_contacts, steady};
use support::{CHORD, SOFT, agree, arc, guide};

/// Spans that differ, against a second program.
#[test]
fn onset_of_two_contacts() {
    for (ratio, wanted) in [(0.5, 1.254), (0.8, 0.855), (1.5, 0.328), (2.0, 0.284), (4.0, 0.111)] {
        let onset = ripple_of_two_contacts(ratio).unwrap().unwrap();
        agree("P_c", onset.steering_number, wanted, 5e-3);
    }
    assert!(ripple_of_two_contacts(0.0).is_err() && ripple_of_two_contacts(f64::NAN).is_err());
}

/// The delay equation itself, stepped: a small kink grows below P_c and decays above it.
#[test]
fn a_kink_grows_below_the_onset_alone() {
    let onset = ripple_of_two_contacts(1.0).unwrap().unwrap().steering_number;
    let growth = |steering: f64| {
        let a = (1.0 - 6.0 / steering) / 4.0;
        let per = 1000;
        let mut y = vec![0.0_f64; 2 * per + 1];
        *y.last_mut().unwrap() = 1e-3;
        let extent = |y: &[f64]| {
            let bends = y.windows(3).step_by(10).map(|at| (at[2] - 2.0 * at[1] + at[0]).abs());
            bends.fold(0.0, f64::max)
        };
        for _ in 0..60 * per {
            let last = y.len() - 1;
            let (near, far) = (y[last - per], y[last - 2 * per]);
            let slope = (1.0 + a) * (y[last] - near) - a * (near - far);
            y.push(y[last] + slope / per as f64);
        }
        extent(&y[y.len() - 3 * per..]) / extent(&y[20 * per..23 * per])
    };
    let (above, below) = (growth(1.1 * onset), growth(0.9 * onset));
    println!("times {above} above, {below} below");
    assert!(above < 0.9 && below > 1.1, "{above} {below}");
}

/// The wrapped guide: the hole from an arc is smooth at P 2.6 and ripples at P 1.1 with a period of about l.
#[test]
fn a_guide_on_the_wall_ripples_below_its_threshold() {
    let level = Guide {
        gravity: Gravity::LowSide,
        ..guide(SOFT)
    };
    // Steering numbers depend on eta through l: a search over eta.
    let law_of = |wanted: f64| {
        let (mut low, mut high) = (1.2, 40.0);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            let number = steady(&level, &BitLaw::sharp(10e3, middle), 1.0)
                .unwrap()
                .steering_number;
            if number < wanted { low = middle } else { high = middle }
        }
        BitLaw::sharp(10e3, low)
    };
    for (number, most, least) in [(2.6, 2e-3, 0.0), (1.1, 0.1, 5e-3)] {
        let (mut propagation, _) = Propagation::begin(level, law_of(number), arc(90.0, CHORD), CHORD).unwrap();
        let drilled = propagation.drill(24.0).unwrap();
        let last: Vec<f64> = drilled[drilled.len() - 200..].iter().map(|at| at.build).collect();
        let mean = last.iter().sum::<f64>() / 200.0;
        let spread = (last.iter().map(|kb| (kb - mean).powi(2)).sum::<f64>() / 200.0).sqrt();
        let crossings = last.windows(2).filter(|at| at[0] < mean && at[1] >= mean).count();
        println!("P {number}: spread {spread:.5} 1/m, {crossings} waves in 8 m, mean {mean:.4}");
        assert!(spread <= most && spread >= least, "P {number}: {spread}");
    }
}
