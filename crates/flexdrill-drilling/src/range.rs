//! What the guide of a configuration drills in a long arc, and which arcs it drills with no bit: what `flexdrill check`
//! says before a run.

use flexdrill_config::{BitAxis, Config, FreeBend, Section};
use flexdrill_core::units::kn_to_n;
use flexdrill_hole::{Bounds, bounds, steady};

use super::{Long, Plan, USUAL_WEIGHT, plan, tool};

/// Sine of the inclination of a level hole.
const LEVEL: f64 = 1.0;
/// Weights at which a guide that its weight bends is asked for its bounds: they change by some per cent from one to the next.
const WEIGHTS: u32 = 32;

/// What the guide drills.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// A weight at which it is asked for (N): that at which a run begins, else the usual one.
    pub weight: f64,
    /// What it drills in a long arc at that weight; none where the bit cuts nothing or the thrust bends it without limit.
    pub long: Option<Long>,
    /// Largest weight that the inputs allow (N).
    pub largest_weight: f64,
    /// Curvatures that no bit and no rock leaves, from no weight to the largest; none where the thrust bends the guide
    /// without limit.
    pub bounds: Option<Bounds>,
}

/// A curvature that the guide does not drill, whatever the bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Excluded {
    /// An arc of `well.sections` with this radius (m).
    Arc(f64),
    /// The plan, which needs this curvature (1/m) on the mean over a length (m) below the bit.
    Plan {
        /// Mean curvature (1/m).
        curvature: f64,
        /// Over this length (m).
        ahead: f64,
    },
}

/// Curvatures that no bit and no rock leaves in a long arc, from no weight to the largest (N); none where the thrust bends the
/// guide without limit.
pub fn whatever_the_bit(config: &Config, largest: f64) -> Option<Bounds> {
    // A bent guide presses the harder the larger the weight. One that drops is pressed most without any. A weight that bends
    // the guide moves both bounds with it, so that the extremes may lie between.
    let steps = if config.tool.guide.has_spine_off_axis() {
        WEIGHTS
    } else {
        1
    };
    let weights = (0..=steps).map(|step| largest * f64::from(step) / f64::from(steps));
    let all = weights.map(|weight| bounds(&tool::guide(config, weight), weight, LEVEL).ok());
    all.reduce(|one, other| {
        let (one, other) = (one?, other?);
        Some(Bounds {
            low: one.low.min(other.low),
            high: one.high.max(other.high),
        })
    })
    .flatten()
}

impl Range {
    /// Of a configuration whose guide has a free curvature as a number or in pieces, in the plane of the build, and holds the bit's axis.
    pub fn of(config: &Config) -> Option<Self> {
        let guide = &config.tool.guide;
        let is_given = !matches!(guide.free_curvature, FreeBend::Path(_));
        // A guide rolled out of the plane of the build, or bent out of it by thrust, drills out of it, for which no closed form
        // holds.
        let is_in_plane = guide.free_curvature_phase_deg == 0.0 && guide.thrust_bend_toolface_deg() % 180.0 == 0.0;
        if !is_given || !is_in_plane || guide.fixed || config.tool.bit.axis() == BitAxis::Link {
            return None;
        }
        let inputs = &config.inputs.weight_on_bit;
        let [least, largest, initial] = [inputs.min_kn, inputs.max_kn, inputs.initial_kn].map(kn_to_n);
        // A run that begins off bottom says nothing of the weight under which it will drill.
        let weight = if initial > tool::wear_flats(config) {
            initial
        } else {
            USUAL_WEIGHT.clamp(least, largest)
        };
        // A long arc ends level, where the weight of guide and pipe is largest across the hole.
        let long = tool::bit(config, weight)
            .ok()
            .and_then(|law| steady(&tool::guide(config, weight), &law, LEVEL).ok())
            .map(Long::from);
        Some(Self {
            weight,
            long,
            largest_weight: largest,
            bounds: whatever_the_bit(config, largest),
        })
    }

    /// Whether it excludes a curvature (1/m).
    fn excludes(&self, curvature: f64) -> bool {
        self.bounds
            .is_some_and(|bounds| curvature < bounds.low || curvature > bounds.high)
    }

    /// Arcs of the hole and a plan (its rows) that this guide cannot drill. What lies above the bit of the plan is drilled.
    pub fn excluded(&self, config: &Config, rows: Option<&[plan::Row]>) -> Vec<Excluded> {
        // Hole as drilled is there, whichever tool has drilled it.
        let arcs = config.well.sections.iter();
        let arcs = arcs.filter(|section| matches!(section, Section::Arc { .. }));
        let mut excluded: Vec<Excluded> = arcs
            .filter(|arc| self.excludes(arc.curvature()))
            .map(|arc| Excluded::Arc(1.0 / arc.curvature()))
            .collect();
        let bit = config.well.length();
        if let Some((curvature, ahead)) = rows.and_then(|rows| Plan::needs(rows, bit))
            && self.excludes(curvature)
        {
            excluded.push(Excluded::Plan { curvature, ahead });
        }
        excluded
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AHEAD: &str = include_str!("../../../tests/data/ahead.yaml");

    fn config(changes: &[(&str, &str)], more: &str) -> Config {
        let mut text = AHEAD.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        Config::from_text("tool.yaml", &(text + more)).unwrap()
    }

    /// The paper's guide at 10 kN: 2.81 and 3.65 m with p at the bound itself, and 0.319 1/m with a sharp bit in a level
    /// hole (docs/hole_ahead.md).
    #[test]
    fn the_papers_guide_has_the_radii_of_the_closed_form() {
        let config = config(&[], "inputs: {weight_on_bit: {initial_kn: 10, max_kn: 10}}\n");
        let range = Range::of(&config).unwrap();
        let bounds = range.bounds.unwrap();
        // The documented radii are rounded to a centimetre.
        assert!(
            (1.0 / bounds.high - 2.81).abs() < 0.006 && (1.0 / bounds.low - 3.65).abs() < 0.006,
            "{bounds:?}"
        );
        let long = range.long.unwrap();
        // The closed form has 3.145 m for this guide and bit (docs/hole_ahead.md).
        assert!((1.0 / long.curvature - 3.145).abs() < 0.006, "{long:?}");
        assert!(range.excluded(&config, None).is_empty());
    }

    #[test]
    fn an_arc_or_a_plan_outside_the_range_is_named() {
        let rows = |inclinations: [f64; 2]| {
            [0.0, 10.0].map(|depth| plan::Row {
                depth,
                inclination: inclinations[usize::from(depth > 0.0)],
                azimuth: 0.0,
            })
        };
        // A straight guide builds a radius of some 30 m at 60 kN at best.
        let straight = config(&[("free_curvature: 0.3125", "free_curvature: 0")], "");
        let range = Range::of(&straight).unwrap();
        // (2 c/EI)(W kb + q) = kb2 with W 60 kN, c 8 mm, q 361.5 N/m and EI 0.05 * 6.8037e5 N m2: kb 0.0332 1/m.
        let [half, rest]: [f64; 2] = [60e3, 361.5].map(|of| of * 2.0 * 0.008 / (0.05 * 6.8037e5));
        let high: f64 = half / 2.0 + (half * half / 4.0 + rest).sqrt();
        assert!(
            (range.bounds.unwrap().high / high - 1.0).abs() < 1e-3,
            "{range:?} {high}"
        );
        assert_eq!(range.excluded(&straight, None), [Excluded::Arc(3.2)]);
        // A hole that remains level can be drilled with it.
        let level = rows([1.5, 1.5]);
        assert_eq!(range.excluded(&straight, Some(&level)), [Excluded::Arc(3.2)]);
        // 1/3.2 over 5 m below the bit.
        let arc = rows([0.0, 3.125]);
        let [_, Excluded::Plan { curvature, ahead }] = range.excluded(&straight, Some(&arc))[..] else {
            panic!("{:?}", range.excluded(&straight, Some(&arc)))
        };
        assert!((curvature - 0.3125).abs() < 1e-9 && (ahead - 10.0 + straight.well.length()).abs() < 1e-9);
        // The curved guide drills the arc, and no level hole.
        let curved = config(&[], "");
        let range = Range::of(&curved).unwrap();
        assert!(range.excluded(&curved, Some(&arc)).is_empty());
        assert!(matches!(
            range.excluded(&curved, Some(&level))[..],
            [Excluded::Plan { .. }]
        ));
    }

    /// A straight guide that thrust bends drills the arc at some weight, and with shut slots it does not reach the arc: bounds
    /// of the closed form with kf = min(e W / EI, k_c).
    #[test]
    fn the_weight_bends_a_guide_with_a_spine_off_its_axis() {
        let straight = "bending_factor: 0.05, free_curvature: 0.3125";
        let with = |guide: &str| config(&[(straight, guide)], "");
        let guide = "bending_factor: 0.01, free_curvature: 0, spine_offset: 0.045";
        assert!(Range::of(&with(guide)).unwrap().excluded(&with(guide), None).is_empty());
        let shut = with(&format!("{guide}, slots_close_at: 0.05"));
        let range = Range::of(&shut).unwrap();
        // (2 c/EI)(W kb + q) = (kb - k_c)2 with W 60 kN, and k_c from 7.6 kN on.
        let high = range.bounds.unwrap().high;
        let reach = (2.0 * 0.008 * (60e3 * high + 361.5) / (0.01 * 6.8037e5)).sqrt();
        assert!((high - 0.05 - reach).abs() < 1e-3 * high, "{range:?}");
        let stiff = with("bending_factor: 0.05, free_curvature: 0, spine_offset: 0.045, slots_close_at: 0.05");
        let range = Range::of(&stiff).unwrap();
        assert_eq!(range.excluded(&stiff, None), [Excluded::Arc(3.2)], "{range:?}");
        // The weight does not act in the plane of the build alone.
        let aside = "bending_factor: 0.01, free_curvature: 0, spine_offset: 0.045, spine_toolface_deg: 90";
        let held = "boundary: {supports: [{at: top, body: guide, fix: [psi]}]}\n";
        assert_eq!(Range::of(&config(&[(straight, aside)], held)), None);
    }

    #[test]
    fn nothing_is_said_of_a_guide_without_a_number_or_that_does_not_hold_the_bit() {
        for change in [
            (", free_curvature: 0.3125", ""),
            ("lateral_resistance: 20", "lateral_resistance: 20, axis: link"),
            ("bending_factor: 0.05, free_curvature: 0.3125", "fixed: true"),
        ] {
            assert_eq!(Range::of(&config(&[change], "")), None, "{change:?}");
        }
    }

    #[test]
    fn a_run_that_begins_off_bottom_is_asked_for_the_usual_weight() {
        let weight = |inputs: &str| Range::of(&config(&[], inputs)).unwrap().weight;
        assert_eq!(weight(""), 10e3);
        assert_eq!(weight("inputs: {weight_on_bit: {max_kn: 8}}\n"), 8e3);
        assert_eq!(weight("inputs: {weight_on_bit: {initial_kn: 14}}\n"), 14e3);
    }
}
