//! Draws the figure of `docs/effects/spine.md`: how thrust bends a guide whose spine lies off its axis, in closed form and by
//! the statics of the hole ahead.
//!
//!     cargo xtask figure spine docs/images/spine.svg
//!
//! The guide is that of `config/default.yaml` with a bending factor of 0.05, and the numbers are those of
//! `crates/flexdrill-hole/tests/spine.rs`, which holds both to each other.

use std::f64::consts::PI;
use std::path::Path;

use anyhow::{Context as _, ensure};
use flexdrill_bench::changed;
use flexdrill_config::Config;
use flexdrill_core::units::{deg_to_rad, kn_to_n};
use flexdrill_drilling::tool::{chord, guide};
use flexdrill_hole::{BitLaw, Gravity, Guide, Hole, Propagation, Spine, at_rest, steady};
use flexdrill_plot::{Figure, Legend, Line, Panel, svg_of_width};

/// Width of a drawing, whose texts are then read on a telephone.
const WIDTH: u32 = 480;
/// Distance of the spine from the guide's axis (m): about that of a spine of 40 degrees.
const OFFSET: f64 = 0.045;

/// Length of the column (m), and its thrust (N).
const COLUMN: f64 = 1.5;
const THRUST: f64 = 20e3;
/// Gap of a column that touches no wall (m).
const FREE: f64 = 1.0;

/// Curvature of the guide that drills, as made, and that at which its slots are shut (1/m).
const AS_MADE: f64 = 0.29;
const SHUT: f64 = 0.02;
/// Lateral resistance of the bit.
const RESISTANCE: f64 = 20.0;
/// Length that is drilled, and the part at its end whose curvature is taken (m).
const DRILLED: f64 = 14.0;
const JUDGED: f64 = 3.0;

/// # Errors
/// When the statics have no solution or the file cannot be written.
pub(crate) fn draw(to: &Path) -> anyhow::Result<()> {
    let soft = ["tool.guide.bending_factor=0.05".to_owned()];
    let config = changed(Config::load("config/default.yaml")?, None, &soft)?;
    // Off the bottom no torque pushes the bit aside, and the pictures show the thrust alone.
    let guide = guide(&config, 0.0);
    let figure = Figure {
        name: "spine",
        title: String::new(),
        caption: String::new(),
        columns: 1,
        height: 330,
        panels: vec![by_toolface(&guide)?, by_weight(&guide)?],
    };
    std::fs::write(to, svg_of_width(&figure, WIDTH)?).with_context(|| format!("{}: cannot be written", to.display()))
}

/// Tilt of the lower end of a column between its ends over the toolface of its spine: the secant formula
/// t = e k tan(k L/2) with k^2 = C/EI, away from the spine, and the statics.
fn by_toolface(guide: &Guide) -> anyhow::Result<Panel> {
    let k = (THRUST / guide.bending_stiffness).sqrt();
    let tilt = 1e3 * OFFSET * k * (0.5 * k * COLUMN).tan();
    let hole = Hole::begin(0.0, 0.0)?.straight(COLUMN, 0.02 * COLUMN)?;
    // The thrust bends the guide to the side opposite to the spine.
    let bend = |toolface: f64| deg_to_rad(toolface) - PI;
    let mut statics = [Vec::new(), Vec::new()];
    for toolface in (0..=12).map(|index| f64::from(30 * index)) {
        let column = Guide {
            length: COLUMN,
            free_curvature: 0.0,
            weight_per_metre: 0.0,
            gap: FREE,
            wall_friction: 0.0,
            spine: Some(Spine {
                offset: OFFSET,
                turn: bend(toolface),
                most: None,
            }),
            ..*guide
        };
        let rest = at_rest(&column, THRUST, &hole)?;
        // Across the hole low is positive, and the picture shows what builds.
        statics[0].push((toolface, -1e3 * rest.tilt.y));
        statics[1].push((toolface, 1e3 * rest.tilt.x));
    }
    let formula = |of: fn(f64) -> f64| -> Vec<(f64, f64)> {
        let toolfaces = (0..=72).map(|index| f64::from(5 * index));
        toolfaces
            .map(|toolface| (toolface, tilt * of(bend(toolface))))
            .collect()
    };
    // Lines below, points above: where both agree, a point hides its line.
    let [high, right] = statics;
    Ok(Panel::new(
        "Column of 1.5 m under 20 kN: tilt of its lower end",
        "toolface of the spine (deg), 180 on the low side",
        "mrad",
    )
    .legend(Legend::Stacked)
    .over(0.0, 360.0)
    .line(Line::new("to the high side, closed form", formula(f64::cos)).color(0))
    .line(Line::new("to the right, closed form", formula(f64::sin)).color(1))
    .line(Line::new("statics, high side", high).dots().color(0))
    .line(Line::new("statics, right", right).dots().color(1)))
}

/// Curvature to which a guide drills over the weight, with a spine on the low side and with one on the axis: in closed form and
/// by the statics, in a hole across which the weight of the guide acts with its full size.
fn by_weight(guide: &Guide) -> anyhow::Result<Panel> {
    let spine = Spine {
        offset: OFFSET,
        turn: 0.0,
        most: Some(SHUT),
    };
    let mut panel = Panel::new(
        "Curvature that a guide of 0.29 1/m drills to",
        "weight on bit (kN)",
        "1/m",
    )
    .legend(Legend::Stacked);
    for (name, spine, color) in [("spine on the low side", Some(spine), 0), ("on the axis", None, 1)] {
        let guide = Guide {
            gravity: Gravity::LowSide,
            free_curvature: AS_MADE,
            spine,
            ..*guide
        };
        let [mut formula, mut statics] = [Vec::new(), Vec::new()];
        for weight in 6..=22_u32 {
            let law = BitLaw::sharp(kn_to_n(f64::from(weight)), RESISTANCE);
            let curvature = steady(&guide, &law, 1.0)?.curvature;
            formula.push((f64::from(weight), curvature));
            // Every second one shows as much, and the points remain apart.
            if weight % 2 == 0 {
                statics.push((f64::from(weight), drilled(&guide, &law, curvature)?));
            }
        }
        panel = panel
            .line(Line::new(format!("{name}, closed form"), formula).color(color))
            .line(Line::new(format!("{name}, statics"), statics).dots().color(color));
    }
    Ok(panel)
}

/// Mean build curvature (1/m) at the end of a hole that begins with a curvature.
fn drilled(guide: &Guide, law: &BitLaw, curvature: f64) -> anyhow::Result<f64> {
    let chord = chord(guide);
    // The guide lies in the arc as a whole.
    let angle = (guide.length + 0.1) * curvature;
    let hole = Hole::begin(0.0, 0.0)?.arc(1.0 / curvature, angle, chord)?;
    let (mut propagation, _) = Propagation::begin(*guide, *law, hole, chord)?;
    let drilled = propagation.drill(DRILLED)?;
    let judged = drilled.len().saturating_sub((JUDGED / chord) as usize);
    let last = &drilled[judged..];
    ensure!(!last.is_empty(), "nothing was drilled");
    Ok(last.iter().map(|at| at.build).sum::<f64>() / last.len() as f64)
}
