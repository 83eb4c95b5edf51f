//! Physics that cannot be names both keys.

use super::*;

#[test]
fn friction_and_weight_are_refused_where_they_have_no_meaning() {
    let error = error_of(&format!(
        "{GOOD}contact: {{outer: {{friction: bristle, slip_speed: 1.0e-4}}}}\n"
    ));
    assert!(
        error.contains("contact.outer.slip_speed = 0.0001 m/s") && error.contains("friction: bristle"),
        "{error}"
    );
    let error = error_of(&format!(
        "{GOOD}contact: {{inner: {{friction: vector, slip_speed: 0}}}}\n"
    ));
    assert!(error.contains("contact.inner.slip_speed = 0 m/s"), "{error}");
    for (other, named) in [
        ("wob_path: shared", "boundary.wob_path"),
        ("bottom_axial: fixed", "boundary.bottom_axial"),
        (
            "preset: none, supports: [{at: bottom, body: guide, fix: [v]}]",
            "boundary.supports",
        ),
    ] {
        let error = error_of(&format!("{GOOD}boundary: {{weight_on_bit_at: kickoff, {other}}}\n"));
        assert!(
            error.contains("boundary.weight_on_bit_at = kickoff") && error.contains(named),
            "{error}"
        );
    }
    let text = format!("{GOOD}boundary: {{weight_on_bit_at: kickoff}}\n");
    let tool = Config::from_text("rig.yaml", &text).unwrap().tool();
    tool.validate().unwrap();
    // The mechanics refuses the same on its own.
    for change in [
        |tool: &mut ToolDescription| tool.wob_path = WobPath::Shared,
        |tool: &mut ToolDescription| tool.supports.clear(),
        |tool: &mut ToolDescription| tool.guide_fixed = true,
    ] {
        let error = tool.clone().with(change).validate().unwrap_err().to_string();
        assert!(error.contains("weight_place"), "{error}");
    }
}

#[test]
fn places_are_held_against_the_mesh() {
    let load = |at: &str| {
        format!("{GOOD}loads:\n  - at: {at}\n    body: pipe\n    direction: w\n    history: {{constant: 1}}\n")
    };
    assert!(Config::from_text("rig.yaml", &load("{joint: 31}")).is_ok());
    assert!(error_of(&load("{joint: 32}")).starts_with("rig.yaml:11: loads.0.at.joint = 32: must be 0 to 31"));
    assert!(Config::from_text("rig.yaml", &load("{station: 165}")).is_ok());
    assert!(error_of(&load("{station: 166}")).contains("loads.0.at.station = 166: must be 0 to 165"));
    assert!(error_of(&load("{measured_depth: 5.1}")).contains("loads.0.at.measured_depth = 5.1 m"));
}

#[test]
fn a_body_has_the_inertia_that_a_body_can_have() {
    let mass = |more: &str| format!("{GOOD}masses:\n  - {{at: bottom, body: pipe, mass: 8, inertia: 0.02{more}}}\n");
    let disc = Config::from_text("rig.yaml", &mass("")).unwrap().tool().masses[0];
    assert_eq!((disc.axial_inertia, disc.transverse_inertia), (0.02, 0.01));
    let long = Config::from_text("rig.yaml", &mass(", transverse_inertia: 0.3")).unwrap();
    assert_eq!(long.tool().masses[0].transverse_inertia, 0.3);
    assert!(error_of(&mass(", transverse_inertia: 0.009")).starts_with(
        "rig.yaml:11: masses.0.transverse_inertia = 0.009 kg m2: must be at least half of inertia, 0.01 kg m2 (a thin disc"
    ));
    assert!(error_of(&mass(", eccentricity: -0.1")).contains("masses.0.eccentricity = -0.1 m: must be 0 to 1 m"));
}

/// What a pressure, a guide's free curvature, and mud need of other keys.
#[test]
fn impossible_pressures_preloads_and_mud_name_both_keys() {
    for (more, key, reason) in [
        (
            "environment: {pressure: {at_top: 5e6}}\n",
            "environment.pressure.end = left out",
            "closed, sealed or held",
        ),
        (
            "environment: {pressure: {end: sealed}}\n",
            "environment.pressure.seal_diameter = left out",
            "given with end sealed",
        ),
        (
            "environment: {pressure: {end: closed, seal_diameter: 0.06}}\n",
            "environment.pressure.seal_diameter = 0.06",
            "only with it",
        ),
        (
            "environment: {pressure: {end: held}}\n",
            "environment.pressure.end = held",
            "boundary.wob_path",
        ),
        (
            "environment: {pressure: {end: closed}}\nboundary: {wob_path: shared}\n",
            "environment.pressure.end = closed",
            "must be held",
        ),
        (
            "environment: {pressure: {end: closed, drop_per_metre: 0.3}}\n",
            "environment.pressure.drop_per_metre = 0.3 1/m",
            "one over the tool's length",
        ),
        (
            "environment: {mud: {film: squeeze, viscosity: 0}}\n",
            "environment.mud.film = squeeze",
            "environment.mud.viscosity above 0",
        ),
        ("start: slid_in\n", "start = slid_in", "contact.outer.friction: bristle"),
    ] {
        let error = error_of(&(GOOD.to_owned() + more));
        assert!(error.contains(key) && error.contains(reason), "{error}");
    }
    for (guide, key, reason) in [
        (
            "free_curvature: 0, fixed: true",
            "tool.guide.free_curvature = 0 1/m",
            "tool.guide.fixed",
        ),
        (
            "free_curvature: 0.1, free_curvature_phase_deg: 90",
            "tool.guide.free_curvature_phase_deg = 90 deg",
            "boundary.supports",
        ),
        (
            "free_curvature_phase_deg: 90",
            "tool.guide.free_curvature_phase_deg = 90 deg",
            "tool.guide.free_curvature is as_built",
        ),
        (
            "free_curvature: -0.1",
            "tool.guide.free_curvature = -0.1 1/m",
            "0 to 2 1/m",
        ),
        (
            "slots_close_at: 0.2",
            "tool.guide.slots_close_at = 0.2 1/m",
            "tool.guide.bending_factor is 1",
        ),
        (
            "bending_factor: 0.05, slots_close_at: 0.2, fixed: true",
            "tool.guide.slots_close_at = 0.2 1/m",
            "tool.guide.fixed",
        ),
        (
            "spine_offset: 0.02",
            "tool.guide.spine_offset = 0.02 m",
            "tool.guide.bending_factor is 1",
        ),
        (
            "bending_factor: 0.05, spine_offset: 0.052",
            "tool.guide.spine_offset = 0.052 m",
            "at most 0.051 m",
        ),
        (
            "bending_factor: 0.05, spine_offset: -0.01",
            "tool.guide.spine_offset = -0.01 m",
            "0 to 0.15 m",
        ),
        (
            "bending_factor: 0.05, spine_offset: 0.02, fixed: true",
            "tool.guide.spine_offset = 0.02 m",
            "tool.guide.fixed",
        ),
        (
            "bending_factor: 0.05, spine_offset: 0.02, spine_toolface_deg: 0",
            "tool.guide.spine_toolface_deg = 0 deg",
            "boundary.supports",
        ),
        (
            "spine_toolface_deg: 90",
            "tool.guide.spine_toolface_deg = 90 deg",
            "tool.guide.spine_offset is 0",
        ),
        (
            "bending_factor: 0.05, slots_close_at: 0",
            "tool.guide.slots_close_at = 0 1/m",
            "above 0, at most 10 1/m",
        ),
    ] {
        let with = format!("inner_diameter: 0.080, {guide}}}");
        let error = error_of(&replaced("inner_diameter: 0.080}", &with));
        assert!(error.contains(key) && error.contains(reason), "{error}");
    }
    let error = error_of(&replaced(
        "inner_diameter: 0.080}",
        "inner_diameter: 0.080, free_curvature: straight}",
    ));
    assert!(error.contains("free_curvature"), "{error}");
}

/// What a string and a rock that holds the bit need of other keys.
#[test]
fn impossible_strings_and_rocks_name_both_keys() {
    const LINE: &str =
        "string: {model: line, sections: [{length: 1000, outer_diameter: 0.073, inner_diameter: 0.0546}]}\n";
    let with_line = |more: &str| format!("{GOOD}{LINE}{more}");
    for (text, key, reason) in [
        (
            with_line("boundary: {drive: none}\n"),
            "boundary.drive = none",
            "string.model: line",
        ),
        (
            with_line("inputs: {rotary_speed: {measured: downhole}}\n"),
            "string.model = line",
            "inputs.rotary_speed.measured: surface",
        ),
        (
            format!("{GOOD}string: {{model: measured}}\n"),
            "string.model = measured",
            "inputs.rotary_speed.measured: downhole",
        ),
        (
            format!("{GOOD}rock: {{law: depth_of_cut}}\n"),
            "rock.law = depth_of_cut",
            "string.model: line",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {bottom_axial: fixed}\n"),
            "boundary.bottom_axial = fixed",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {weight_on_bit_at: kickoff}\n"),
            "boundary.weight_on_bit_at = kickoff",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {preset: none}\n"),
            "boundary.preset = none",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {supports: [{at: top, body: guide, fix: [u]}]}\n"),
            "boundary.supports = u of a pipe at the top",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\n")
                .replace("inner_diameter: 0.080}", "inner_diameter: 0.080, fixed: true}"),
            "tool.guide.fixed = true",
            "rock.law: depth_of_cut",
        ),
        // The string turns the first link, which nothing else may hold.
        (
            with_line("boundary: {supports: [{at: top, body: pipe, fix: [psi]}]}\n"),
            "boundary.supports.0.fix = psi of the driven node",
            "boundary.drive none",
        ),
    ] {
        let error = error_of(&text);
        assert!(error.contains(key) && error.contains(reason), "{error}");
    }
    // The rock then holds both ends together.
    let shared = with_line("rock: {law: depth_of_cut}\nboundary: {wob_path: shared}\n");
    assert!(Config::from_text("rig.yaml", &shared).is_ok());
}
