//! Factors on the bands.

use super::*;

/// Bands with a factor are those of the members, widened about their middle; the message has the factor. A factor of no figure
/// is refused.
#[test]
fn a_band_is_wider_by_the_factor_of_its_figure() {
    let (torque, force) = ("transfer/bit_torque", "contact_forces/max_pipe_guide_force");
    let of = |factors: &str| {
        let text = format!("{TOOL}uncertainty:\n{FRICTION}\nensemble: {{members: 12, band_factors: [{factors}]}}\n");
        Arc::new(Config::from_text("tool.yaml", &text).unwrap())
    };
    let bands = |config: &Arc<Config>| {
        let mut ensemble = begun(config, &[acts(config, 0, 60.0, 10.0)], 12);
        ensemble.hear(Told::Reached(5 * SECOND));
        found(&mut ensemble, 2).pop().unwrap()
    };
    let plain = bands(&of(""));
    let wide = bands(&of(&format!(
        "{{figure: {torque}, factor: 1.5, source: a test}}, {{figure: {force}, factor: 8, source: a test}}"
    )));
    assert!(plain.band_factors.iter().all(|factor| *factor == 1.0));
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs().max(1.0);
    for ((before, after), factor) in plain.bands.iter().zip(&wide.bands).zip(&wide.band_factors) {
        let wanted = match before.name.as_str() {
            name if name == torque => 1.5,
            name if name == force => 8.0,
            _ => 1.0,
        };
        assert_eq!(*factor, wanted, "{}", before.name);
        if before.p50.is_finite() {
            let widened = |end: f64| before.p50 + wanted * (end - before.p50);
            // A largest force is never below 0, however wide its band is.
            let least = if before.name == force { 0.0 } else { f64::NEG_INFINITY };
            assert!(
                close(after.p5, widened(before.p5).max(least)) && close(after.p95, widened(before.p95)),
                "{after:?}"
            );
        }
    }
    let half =
        |bands: &Bands, station: usize| bands.pipe_guide_force_p95[station] - bands.pipe_guide_force_p50[station];
    for station in 0..plain.measured_depth.len() {
        assert!(close(half(&wide, station), 8.0 * half(&plain, station)), "{station}");
    }
    assert_eq!(wide.guide_wall_force_p95, plain.guide_wall_force_p95);
    let lows = || wide.pipe_guide_force_p5.iter().copied();
    assert!(
        lows().all(|low| low >= 0.0) && lows().any(|low| low == 0.0),
        "{:?}",
        wide.pipe_guide_force_p5
    );
    let unknown = of("{figure: transfer/bit_torqe, factor: 2, source: a test}");
    let error = Ensemble::of(&unknown, None).err().unwrap().to_string();
    assert!(error.contains("did you mean transfer/bit_torque?"), "{error}");
}
