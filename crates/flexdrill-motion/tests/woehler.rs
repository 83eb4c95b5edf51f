//! From counted load cycles to the damage of a class: closed forms, the printed tables, and the band.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_motion::{Ageing, AgeingSettings, AgeingWatch, Detail, Woehler, cycle_weight};

/// A watch of one joint with a rated moment of 100 N m.
fn watch(slope: f64, below: f64, knees: [f64; 2]) -> AgeingWatch {
    let mut settings = AgeingSettings::default();
    (settings.slope, settings.slope_below_knee, settings.knees) = (slope, below, knees);
    AgeingWatch::new(&settings, 1, 1)
}

/// What it has counted of the stop and the link.
fn sums(watch: &AgeingWatch) -> [f64; 2] {
    let mut out = Ageing::default();
    watch.write(&mut out);
    [out.stop_damage[0], out.bending_damage[0]]
}

/// Class D of DNVGL-RP-C203 (2016), table 2-1, in air.
fn class_d() -> Woehler {
    Woehler::from_design(12.164, 3.0, 0.2).with_knee(1e7, 5.0)
}

fn detail(line: Woehler) -> Detail {
    Detail {
        line,
        section_modulus: 1e-5,
        stress_concentration: 1.5,
        stress_concentration_scatter: 0.2,
    }
}

/// Counted cycles of a detail with a rated moment of 100 N m.
fn counted(detail: &Detail, moments: &[(f64, f64)]) -> f64 {
    let weight = |range: f64| cycle_weight(range / 100.0, detail.line.slopes(), detail.knee_moment() / 100.0);
    moments.iter().map(|(n, range)| n * weight(*range)).sum()
}

/// Table 2-1 prints the fatigue limit at 1e7 cycles and the constant of the second line, to two and three decimals.
#[test]
fn the_second_slope_is_the_printed_one() {
    let printed = [
        (15.117, 4.0, 106.97, 17.146),
        (12.592, 3.0, 73.10, 16.320),
        (12.164, 3.0, 52.63, 15.606),
        (11.855, 3.0, 41.52, 15.091),
        (10.970, 3.0, 21.05, 13.617),
    ];
    for (design, slope, limit, below) in printed {
        let line = Woehler::from_design(design, slope, 0.0).with_knee(1e7, 5.0);
        // Half of the last digit of log10 N is 0.04 % of the range.
        assert!((line.knee / 1e6 / limit - 1.0).abs() < 4e-4, "{line:?}");
        // At 10 MPa, below every knee: log10 N = constant - 5.
        let log = line.cycles(10e6).log10();
        assert!((log - (below - 5.0)).abs() < 0.0015, "{log} against {below}");
    }
}

#[test]
fn cycles_at_one_amplitude_give_n_over_big_n() {
    // 1.5 * 800 / 1e-5 = 120 MPa: N = 10^(12.164 + 0.4) / 120^3.
    let of = detail(class_d());
    let big = 10f64.powf(12.564) / 120f64.powi(3);
    let damage = of.damage(counted(&of, &[(1e5, 800.0)]), 100.0);
    assert!((damage / (1e5 / big) - 1.0).abs() < 1e-12, "{damage}");
    assert!((of.line.cycles(of.stress(800.0)) / big - 1.0).abs() < 1e-12);
    // The rated moment is a unit of the count, and no property of the detail.
    let weight = cycle_weight(800.0 / 37.0, of.line.slopes(), of.knee_moment() / 37.0);
    assert!((of.damage(1e5 * weight, 37.0) / damage - 1.0).abs() < 1e-12);
}

#[test]
fn two_amplitudes_on_both_sides_of_the_knee_add_up() {
    let of = detail(class_d());
    // 120 and 15 MPa; the knee is at 52.63 MPa, with 10^7.4 cycles of the mean line.
    let moments = [(2e5, 800.0), (3e7, 100.0)];
    let knee = 10f64.powf((12.164 - 7.0) / 3.0);
    let expected = 2e5 * 120f64.powi(3) / 10f64.powf(12.564) + 3e7 / (10f64.powf(7.4) * (knee / 15.0).powi(5));
    let damage = of.damage(counted(&of, &moments), 100.0);
    assert!((damage / expected - 1.0).abs() < 1e-12, "{damage} against {expected}");
    // On one slope the small cycles count (52.63 / 15)^2 times as much.
    let straight = detail(Woehler::from_design(12.164, 3.0, 0.2));
    let small = |of: &Detail| of.damage(counted(of, &moments[1..]), 100.0);
    assert!((small(&straight) / small(&of) / (knee / 15.0).powi(2) - 1.0).abs() < 1e-12);
}

/// The record of ASTM E 1049-85, figure 6: each repetition has one cycle of 3, 4, 7 and 9.
#[test]
fn the_standards_record_gives_the_sum_over_its_cycles() {
    let of = detail(Woehler::from_design(11.222, 3.0, 0.2));
    let block = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];
    let after = |blocks: usize| {
        let mut watch = watch(3.0, 3.0, [0.0; 2]);
        for value in block.iter().cycle().take(block.len() * blocks) {
            // The unit of the record is 50 N m.
            watch.sample(4e-3, |_| [50.0 * value, 0.0]);
        }
        of.damage(sums(&watch)[1], 100.0)
    };
    // 1.5 * 50 / 1e-5 = 7.5 MPa per unit of the record.
    let cycles: f64 = [3.0, 4.0, 7.0, 9.0].iter().map(|r| (7.5f64 * r).powi(3)).sum();
    let expected = cycles / 10f64.powf(11.622);
    // The first repetitions leave open cycles, which the later ones keep.
    let per_block = (after(30) - after(20)) / 10.0;
    assert!(
        (per_block / expected - 1.0).abs() < 1e-9,
        "{per_block} against {expected}"
    );
}

/// A second slope of 5 below the knee after 3 above it: a cycle of half the knee counts a quarter.
#[test]
fn cycles_below_the_knee_count_less() {
    let counted = |knees| {
        let mut watch = watch(3.0, 5.0, knees);
        for step in 0..1000 {
            let side = if step % 2 == 0 { 25.0 } else { -25.0 };
            watch.stop(0, 4e-3, side);
            watch.sample(4e-3, |_| [side, 0.0]);
        }
        sums(&watch)
    };
    let straight = counted([0.0, 0.0]);
    assert!(straight[0] > 400.0 * 0.125 && straight[0] == straight[1]);
    for (knees, factors) in [([1.0, 0.4], [0.25, 1.0]), ([0.2, 1.0], [1.0, 0.25])] {
        let bent = counted(knees);
        for of in 0..2 {
            assert!((bent[of] / straight[of] / factors[of] - 1.0).abs() < 1e-12, "{bent:?}");
        }
    }
}

#[test]
fn the_band_has_the_scatter_of_the_class_and_of_the_stress() {
    let mut of = detail(Woehler::from_design(11.222, 3.0, 0.2));
    // The class alone: 1.645 * 0.2 of log10 N.
    of.stress_concentration_scatter = 0.0;
    assert!((of.band().log10() / (1.644_853_6 * 0.2) - 1.0).abs() < 1e-7);
    // The stress alone: a factor on the stress at 95 % to the power of 3.
    (of.line.scatter, of.stress_concentration_scatter) = (0.0, 0.3);
    let factor = (1.644_853_6 * 1.09f64.ln().sqrt()).exp();
    assert!((of.band() / factor.powi(3) - 1.0).abs() < 1e-6);
    // Without either the damage is known, and a second slope widens the band.
    of.stress_concentration_scatter = 0.0;
    assert_eq!(of.band(), 1.0);
    let with = |line| detail(line).band();
    assert!(with(class_d()) > with(Woehler::from_design(12.164, 3.0, 0.2)));
}

/// Draws of both, by the quantiles of a grid: 90 % of the damages lie within the band.
#[test]
fn nine_of_ten_draws_lie_within_the_band() {
    let of = detail(Woehler::from_design(11.222, 3.0, 0.25));
    let median = of.damage(1.0, 100.0);
    let sigma = 1.04f64.ln().sqrt();
    let (mut inside, mut all) = (0.0, 0.0);
    // A grid of both deviates from -4 to 4 with the weight of the normal density.
    for i in -400..=400 {
        for j in -400..=400 {
            let (x, y) = (f64::from(i) / 100.0, f64::from(j) / 100.0);
            let weight = (-0.5 * (x * x + y * y)).exp();
            let mut drawn = of;
            drawn.line.log_cycles += 0.25 * x;
            drawn.stress_concentration *= (sigma * y).exp();
            let ratio = drawn.damage(1.0, 100.0) / median;
            all += weight;
            if (1.0 / of.band()..=of.band()).contains(&ratio) {
                inside += weight;
            }
        }
    }
    // The grid resolves a hundredth of a deviation at either end.
    assert!((inside / all - 0.9f64).abs() < 3e-3, "{}", inside / all);
}
