//! The configuration of a row of the covering array: eight links of three elements in a short, crooked hole.

use super::covering::{
    FILM, GUIDE, INNER, JOINT, MUD, OUTER, PINS, PLAY, PRELOAD, PRESSURE, ROCK, Row, SHORTENING, SLOTS, SPINE, STRING,
    WEIGHT_AT, WELL,
};

/// What a run of a row has besides its switches.
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// Friction of both layers and of the pins is on.
    pub rubs: bool,
    /// Constant pressure at the top (Pa), instead of the input.
    pub pressure: Option<f64>,
    /// Length of the string above (m).
    pub string: f64,
    /// Factor on every mass, force and stiffness.
    pub scale: f64,
}

impl Default for Variant {
    fn default() -> Self {
        Self {
            rubs: true,
            pressure: None,
            string: 600.0,
            scale: 1.0,
        }
    }
}

/// Weight on bit that is asked for (N): twice the force of the wear flats.
pub const WEIGHT: f64 = 4e3;

/// The configuration, YAML.
///
/// The contacts of a joint's play are soft enough for whole steps of 0.5 ms.
///
/// The hole has 1 mm around the guide, which is slotted, so that the guide lies on the wall; in a straight hole a load of
/// 2 kN presses it there. The hole begins at 20 degrees, so that gravity has a part along and a part across.
pub fn yaml(row: &Row, variant: &Variant) -> String {
    let Variant {
        rubs,
        pressure,
        string,
        scale,
    } = *variant;
    let on = |factor: usize| row[factor] > 0;
    let law = |factor: usize| ["separate", "vector", "bristle"][row[factor]];
    let is_straight = row[WELL] == 1;
    let sections = [
        "{arc: {radius: 2.0, build_angle_deg: 36}}",
        "{straight: {length: 1.2566}}",
        "{arc: {radius: 2.0, build_angle_deg: 24}}, {straight: {length: 0.42}}",
    ][row[WELL]];
    let free = match (on(PRELOAD), is_straight) {
        (false, _) => "as_built",
        (true, false) => "0.4",
        (true, true) => "0.1",
    };
    let slots = match (on(SLOTS), on(PRELOAD)) {
        (false, _) => "never",
        (true, false) => "0.005",
        (true, true) => "0.09",
    };
    // e W / EI_f of 4 kN is 0.0047 1/m: enough to close the slots of a guide as built.
    let spine = if on(SPINE) { "0.04" } else { "0" };
    let joint = ["universal", "ball_cage", "revolute"][row[JOINT]];
    let (inner_mu, outer_mu) = if rubs { (0.2, 0.3) } else { (0.0, 0.0) };
    let pins = if on(PINS) && rubs { 0.1 } else { 0.0 };
    let mut text = format!(
        "run: {{title: \"A row of the covering array\"}}
well: {{start_inclination_deg: 20, sections: [{sections}], hole_diameter: 0.104}}
tool:
  links: 8
  elements_per_link: 3
  material: {{youngs_modulus: {}, density: {}}}
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080, bending_factor: 0.05, free_curvature: {free}, slots_close_at: {slots}, spine_offset: {spine}}}
  joint: {{kind: {joint}, limit_deg: 6.0, stop_stiffness: {}, friction: {pins}, play_deg: {}, play_stiffness: {}, hinge_angle: {}}}
  shortening: {}
  bit: {{diameter: 0.104, inertia: {}}}
contact:
  inner: {{stiffness: {}, friction: {}, friction_tangential: {inner_mu}, friction_axial: {inner_mu}}}
  outer: {{stiffness: {}, friction: {}, friction_tangential: {outer_mu}, friction_axial: {outer_mu}}}
",
        2.06e11 * scale,
        7850.0 * scale,
        2e5 * scale,
        if on(PLAY) { 0.3 } else { 0.0 },
        2e3 * scale,
        if row[JOINT] == 2 { "as_built" } else { "straight" },
        if on(SHORTENING) { "second_order" } else { "none" },
        0.01 * scale,
        1e7 * scale,
        law(INNER),
        2e7 * scale,
        law(OUTER),
    );
    text += "environment:\n  buoyancy_factor: 0.86\n";
    if on(MUD) {
        let mass = ["none", "concentric", "eccentric"][row[MUD]];
        let film = if on(FILM) { "squeeze" } else { "none" };
        text += &format!(
            "  mud: {{density: {}, viscosity: {}, added_mass: {mass}, film: {film}}}\n",
            1100.0 * scale,
            0.02 * scale
        );
    }
    if on(PRESSURE) {
        let end = ["", "end: closed", "end: sealed, seal_diameter: 0.063", "end: held"][row[PRESSURE]];
        let at_top = pressure.map_or_else(|| "standpipe".to_owned(), |at_top| format!("{:?}", at_top * scale));
        text += &format!("  pressure: {{at_top: {at_top}, drop_per_metre: 0.01, {end}, joint_seal_diameter: 0.062}}\n");
    }
    text += &format!(
        "boundary:\n  wob_path: {}\n  weight_on_bit_at: {}\n",
        if on(GUIDE) { "shared" } else { "guide" },
        if on(WEIGHT_AT) { "kickoff" } else { "bit" },
    );
    if is_straight {
        text += "  supports: [{at: top, body: guide, fix: [psi]}]\n";
        text += &format!(
            "loads: [{{at: {{station: 12}}, body: guide, direction: w, history: {{constant: {}}}}}]\n",
            2000.0 * scale
        );
    }
    let laws = ["paper", "weakening", "depth_of_cut"];
    text += &format!(
        "rock:
  law: {}
  weakening: {{ratio: {}}}
  depth_of_cut: {{specific_energy: {}, wear_flat_force: {}, cutting_weakening: 0.5}}
",
        laws[row[ROCK]],
        if row[ROCK] > 0 { 1.2 } else { 1.0 },
        1e7 * scale,
        2000.0 * scale
    );
    if on(STRING) {
        text += &format!(
            "string:
  model: line
  sections: [{{length: {string}, outer_diameter: 0.0730, inner_diameter: 0.0546}}]
  material: {{youngs_modulus: {}, density: {}}}
  top_drive: {{tuning: soft_torque, inertia: {}, impedance_ratio: 1.5, torque_limit: {}}}
  hoist: {{stiffness: {}, response_time: 1.0}}
",
            2.06e11 * scale,
            7850.0 * scale,
            50.0 * scale,
            5000.0 * scale,
            5e6 * scale
        );
    }
    // The weight at the start is that of the run, but for a hoist, which begins off bottom.
    let initial = if row[ROCK] == 2 { 0.0 } else { WEIGHT * scale / 1e3 };
    text += &format!(
        "solver: {{step: fixed}}
inputs:
  rotary_speed: {{min_rpm: -60, max_rpm: 60, slew_rpm_per_s: 40, safe_rpm: 0}}
  weight_on_bit: {{initial_kn: {initial}, slew_kn_per_s: {}}}
  rate_of_penetration: {{assumed_m_per_h: 3}}
  standpipe_pressure: {{slew_mpa_per_s: 2}}
  hard_limits: {{min_rpm: -60}}
transfer: {{window: 3}}
outputs:
  rates: {{joint_deflections: 20, contact_forces: 20, bit_state: 20, reactions: 20, tool_shape: 20, transfer: 10, whirl: 0, ageing: 0, joint_states: 0}}
",
        10.0 * scale
    );
    text
}
