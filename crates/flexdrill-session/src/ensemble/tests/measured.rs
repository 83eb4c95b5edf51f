//! Ensembles that are weighed by what a rig measures.

use super::*;
use flexdrill_ensemble::{effective_number, weights};

/// A rig whose friction few of sixteen tools have: its first steady window leaves fewer than eight of them alike, and bands
/// remain. What the window says is not lost: the band moves to the rig's torque once others have replaced them.
#[test]
fn bands_remain_after_a_window_that_few_tools_explain() {
    let config = config(&FRICTION.replace("low: 0.2, high: 0.6", "low: 0.1, high: 1.4"), 16);
    let keys =
        ["inner", "outer"].map(|layer| ["tangential", "axial"].map(|way| format!("contact.{layer}.friction_{way}")));
    let friction = keys.iter().flatten().map(|key| (key.as_str(), 0.3));
    let rig = config.without_uncertainty().with_values("the rig", friction).unwrap();
    let plan = [acts(&config, 0, 60.0, 10.0)];
    let measured = run(&rig, &plan, 190);
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
    let [prior, after] = [15, 189].map(|second: usize| band(&all[second], name));
    let truth = measured[189].0[OverTools::known().iter().position(|known| known.name == name).unwrap()];
    assert!(after[2] - after[0] < 0.7 * (prior[2] - prior[0]), "{prior:?} {after:?}");
    assert!(
        (after[1] - truth).abs() < 0.6 * (prior[1] - truth).abs(),
        "{prior:?} {after:?} {truth}"
    );
    assert!((after[0]..=after[2]).contains(&truth), "{after:?} {truth}");
}

/// The bands of an ensemble whose rig shows `shown` in each second of the twin's run, steady from `from` on in each of its
/// motions, and what its members say of the rig.
fn weighed(
    config: &Arc<Config>,
    plan: &[(u64, RunInputs)],
    twin: &[(Vec<f64>, [f64; RigQuantity::COUNT])],
    shown: impl Fn(usize, &[f64; RigQuantity::COUNT]) -> Vec<(RigQuantity, f64)>,
) -> (Vec<Bands>, Vec<Judgement>) {
    let mut ensemble = begun(config, plan, 12);
    let (mut all, mut judged) = (Vec::new(), Vec::new());
    for (second, (_, values)) in twin.iter().enumerate() {
        let since = plan.iter().map(|(ticks, _)| (ticks / SECOND) as usize);
        let since = since.filter(|changed| *changed <= second).max().unwrap();
        let steady = second >= since + 10;
        for found in second_of(&mut ensemble, second, steady, values, &shown(second, values)) {
            all.push(found.bands);
            judged.push(found.judgement);
        }
    }
    (all, judged)
}

const TORQUE: RigQuantity = RigQuantity::SurfaceTorque;

/// A torque sensor that is stuck at what the tool had is believed until the motion changes. Then its name is published, what
/// it said is withdrawn, and the bands are those of a rig without this sensor. The alarm is judged by it as before.
#[test]
fn a_stuck_sensor_is_named_and_weighs_no_tool() {
    let config = &*WIDE;
    let changed = 65;
    let plan = [
        acts(config, 0, 60.0, 10.0),
        acts(config, changed as u64 * SECOND, 60.0, 25.0),
    ];
    let twin = run(config, &plan, 105);
    let (without, _) = weighed(config, &plan, &twin, |_, _| Vec::new());
    let stuck_at = twin[30].1[TORQUE as usize];
    let (with, judged) = weighed(config, &plan, &twin, |_, _| vec![(TORQUE, stuck_at)]);
    let working = |second: usize, values: &[f64; RigQuantity::COUNT]| {
        // Half of the stated noise, up and down.
        vec![(
            TORQUE,
            values[TORQUE as usize] + if second.is_multiple_of(2) { 0.5 } else { -0.5 },
        )]
    };
    let (believed, _) = weighed(config, &plan, &twin, working);
    assert!(believed.iter().all(|bands| bands.distrusted.is_empty()));

    let named = |bands: &Bands| bands.distrusted == ["surface_torque"] && bands.distrusted_why[0].contains("stuck");
    let first = with.iter().position(named).expect("no second names the sensor");
    // A sensor may be late by twice the age of a sample, 10 s; the means of members lag by 10 s.
    assert!((changed + 10..changed + 22).contains(&first), "{first}");
    assert!(with[first..].iter().all(named) && with[..first].iter().all(|bands| bands.distrusted.is_empty()));
    assert!(
        with[50].effective < 11.9,
        "what a tool does is believed: {}",
        with[50].effective
    );
    let without = without.into_iter().map(believing).collect::<Vec<_>>();
    let after = with.into_iter().map(believing).collect::<Vec<_>>();
    assert!(bytes(&after[first..]) == bytes(&without[first..]));
    // All tools turn with more torque by then, and the alarm sees it.
    let readings = |judged: &Judgement| judged.compared.as_ref().unwrap().readings[TORQUE as usize];
    let last = readings(judged.last().unwrap()).expect("the alarm has no reading");
    assert!(
        (last.measured - stuck_at).abs() < 1e-9 && last.all.unwrap()[0] > stuck_at,
        "{last:?}"
    );
}

/// Channels of hook load and torque that were exchanged: both are named, and no band narrows.
#[test]
fn exchanged_channels_are_both_named() {
    let string = "string: {model: line, sections: [{length: 500, outer_diameter: 0.073, inner_diameter: 0.0546}]}\n";
    let text = format!("{TOOL}{string}uncertainty:\n{FRICTION}\nensemble: {{members: 12}}\n");
    let config = &Arc::new(Config::from_text("tool.yaml", &text).unwrap());
    let plan = [acts(config, 0, 60.0, 10.0)];
    let twin = run(config, &plan, 45);
    let hook = RigQuantity::HookLoad;
    let (without, _) = weighed(config, &plan, &twin, |_, _| Vec::new());
    let (right, _) = weighed(config, &plan, &twin, |_, values| {
        vec![(TORQUE, values[TORQUE as usize]), (hook, values[hook as usize])]
    });
    let (exchanged, _) = weighed(config, &plan, &twin, |_, values| {
        vec![(TORQUE, values[hook as usize]), (hook, values[TORQUE as usize])]
    });
    assert!(right.iter().all(|bands| bands.distrusted.is_empty()));
    let last = exchanged.last().unwrap();
    assert_eq!(last.distrusted, ["surface_torque", "hook_load"]);
    assert!(
        last.distrusted_why
            .iter()
            .all(|why| why.contains("another value in its place"))
    );
    let [with, without] = [exchanged, without].map(|all| all.into_iter().map(believing).collect::<Vec<_>>());
    assert!(bytes(&with) == bytes(&without));
    assert!(bytes(&right) != bytes(&without), "what a tool does is believed");
}

/// A torque that shows less than the tool has, as some plausible tool does, has chosen members before it drifts to its limit.
/// There are no bands while those run, and then the width of the beginning.
#[test]
fn a_sensor_that_drifts_to_its_limit_leaves_the_width_of_the_beginning() {
    let config = &*WIDE;
    let plan = [acts(config, 0, 60.0, 10.0)];
    let twin = run(config, &plan, 250);
    let shown = |second: usize, torque: f64| match second {
        ..125 => 0.96 * torque,
        _ => (0.96 + 0.2 * (second - 125) as f64) * torque,
    };
    let (all, _) = weighed(config, &plan, &twin, |second, values| {
        vec![(TORQUE, shown(second, values[TORQUE as usize]).min(500.0))]
    });
    let name = "transfer/pipe_guide_friction_torque";
    let width = |second: usize| {
        let [low, _, high] = band(&all[second], name);
        high - low
    };
    assert!(
        all[124].renewals > 0 && width(124) < 0.9 * width(15),
        "{} {}",
        width(124),
        width(15)
    );
    let begins = all
        .iter()
        .position(|bands| !bands.distrusted.is_empty())
        .expect("the sensor is not named");
    assert!(begins > 124, "{begins}");
    let without: Vec<usize> = (0..250).filter(|second| !all[*second].no_bands.is_empty()).collect();
    assert!(
        !without.is_empty() && without.len() <= 120 && without[0] >= begins,
        "{without:?}"
    );
    assert!(
        without
            .iter()
            .all(|second| all[*second].no_bands.contains("not believed"))
    );
    let last = all.last().unwrap();
    assert_eq!(
        (last.distrusted.as_slice(), last.no_bands.as_str()),
        (["surface_torque".to_owned()].as_slice(), "")
    );
    // The same tools as at the beginning, whose friction torque ripples by a percent.
    assert!(
        (width(249) / width(15) - 1.0).abs() < 0.1,
        "{} {}",
        width(249),
        width(15)
    );
    assert!((last.effective - 12.0).abs() < 1e-6, "{}", last.effective);
}
