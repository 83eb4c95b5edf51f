//! Ensembles that are weighed by what a rig measures.

use super::*;
use flexdrill_ensemble::{effective_number, weights};

/// A rig whose friction two of sixteen tools have: its first steady window leaves fewer than eight of them alike, and bands
/// remain. What the window says is not lost: the band moves to the rig's torque once others have replaced them.
#[test]
fn bands_remain_after_a_window_that_few_tools_explain() {
    let config = config(&FRICTION.replace("low: 0.2, high: 0.6", "low: 0.1, high: 1.4"), 16);
    let keys =
        ["inner", "outer"].map(|layer| ["tangential", "axial"].map(|way| format!("contact.{layer}.friction_{way}")));
    let friction = keys.iter().flatten().map(|key| (key.as_str(), 0.15));
    let rig = config.without_uncertainty().with_values("the rig", friction).unwrap();
    let plan = [acts(&config, 0, 60.0, 10.0)];
    let measured = run(&rig, &plan, 130);
    let mut ensemble = begun(&config, &plan, 16);
    let (mut all, mut least) = (Vec::new(), f64::INFINITY);
    for (second, (_, values)) in measured.iter().enumerate() {
        let torque = [(RigQuantity::SurfaceTorque, values[RigQuantity::SurfaceTorque as usize])];
        let found = second_of(&mut ensemble, second, second >= 10, values, &torque);
        all.extend(found.into_iter().map(|found| found.bands));
        least = least.min(effective_number(&weights(&ensemble.logs())));
    }
    assert!(least < 7.0, "{least:.1} tools alike: no window says enough");
    let name = "transfer/pipe_guide_friction_torque";
    for (second, bands) in all.iter().enumerate() {
        assert_eq!(bands.no_bands, "", "{second}");
        assert!(bands.effective > 7.99, "{second}: {}", bands.effective);
        let [low, middle, high] = band(bands, name);
        assert!(low < middle && middle < high, "{second}");
    }
    let [prior, after] = [15, 129].map(|second: usize| band(&all[second], name));
    let truth = measured[129].0[OverTools::known().iter().position(|known| known.name == name).unwrap()];
    assert!(after[2] - after[0] < 0.7 * (prior[2] - prior[0]), "{prior:?} {after:?}");
    assert!(
        (after[1] - truth).abs() < 0.6 * (prior[1] - truth).abs(),
        "{prior:?} {after:?} {truth}"
    );
    assert!((after[0]..=after[2]).contains(&truth), "{after:?} {truth}");
}
