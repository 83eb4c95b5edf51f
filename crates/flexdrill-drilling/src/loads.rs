//! Loads of a tool in closed form.

use flexdrill_core::tool::{RockLaw, SectionProperties, ToolDescription, Weakening};

/// Weight per length of guide and pipe (N/m), in mud.
pub fn weights(tool: &ToolDescription) -> [f64; 2] {
    let mass = |tube| SectionProperties::of(tube, tool.material, 1.0).mass;
    let pipe = tool.pipe_sections.iter().map(|&tube| mass(tube)).sum::<f64>() / tool.pipe_sections.len() as f64;
    [tool.gravity * mass(tool.guide_section), tool.gravity * pipe]
}

/// Torque of the rock (N m) at a steady weight (N) and speed (rad/s).
pub fn bit_torque(tool: &ToolDescription, weight: f64, speed: f64) -> f64 {
    let by_weight = tool.bit.friction_factor * tool.bit.diameter / 3.0 * weight;
    let factor = |falls: &Weakening| 1.0 + (falls.ratio - 1.0) * libm::exp(-speed.abs() / falls.rate);
    match &tool.rock {
        RockLaw::Weakening(falls) => by_weight * factor(falls),
        RockLaw::DepthOfCut(cut) => {
            let radius = tool.bit.diameter / 2.0;
            let flats = weight.min(cut.wear_flat_force);
            let depth = (weight - flats) / (cut.cutter_inclination * cut.specific_energy * radius);
            let falls = factor(&cut.weakening);
            0.5 * cut.specific_energy * radius * radius * depth * (1.0 + cut.cutting_weakening * (falls - 1.0))
                + 0.5 * cut.wear_flat_friction * radius * flats * falls
        }
        // The paper's Eq. 1.
        _ => by_weight,
    }
}
