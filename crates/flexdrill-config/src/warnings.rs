//! Warnings about values that are allowed but probably unintended.

use super::solver::{Solver, StepTaken};
use super::{Config, HardBounds, WallFrictionFactors};
use flexdrill_core::tool::{AddedMass, FrictionLaw, HoleInterval, Location, MudFilm, SectionProperties, TorsionalMode};
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

/// Smallest duration of a collision of pipe and guide, in steps. The default tool's lasts 1.5 steps and is accurate; at
/// 0.99 its motion is not, nor that of a stiffer contact at 0.85 (`docs/measurements.md`, model quality). The guide
/// rests on the wall and does not strike it: contacts of 0.3 steps there did no harm.
const FEWEST_STEPS: f64 = 1.1;

/// Longest step (s) in which joints with play were right from the start of a run on. In 0.5 ms the contacts of 0.5 degrees
/// of play close within a step while the tool starts to turn: model quality is poor until the start has left its window
/// (`docs/measurements.md`, the rig's tool).
const LONGEST_WITH_PLAY: f64 = 2.5e-4;

/// Rate of decay (1/s) below which a mode has none: a thousand seconds are longer than a driller waits.
const LEAST_DECAY: f64 = 1e-3;

/// Strain at which a guide of good steel yields: API 5DP grade S-135 has a yield strength of 931 MPa, at 206 GPa.
const YIELD_STRAIN: f64 = 931e6 / 206e9;

/// Bending length on the springs of the wall, in stations, below which the stations of a guide vibrate there by themselves:
/// 2.5 for the guide of `config/rig.yaml`, which rings without damping; 3.9 for 0.05 of a tube's stiffness, which does
/// not.
const LONE_STATIONS: f64 = 3.0;

/// Least share of critical damping of such a station, under [`JUDGED_THRUST`]. The rig's tool rings at 2.6 % and is calm at
/// 6.6 % (`docs/measurements.md`, the rig's tool by step).
const LEAST_DAMPING: f64 = 0.04;

/// Thrust (N) whose side force in the arc presses the stations on the wall: an ordinary weight on bit of such tools.
const JUDGED_THRUST: f64 = 10e3;

/// Torsional modes that are shown and judged: higher ones decay as fast, and the joints' ripple is above them.
const SHOWN_MODES: usize = 4;

impl Config {
    /// The lowest torsional modes of top drive, string and tool off bottom, by frequency; none without a string.
    pub fn torsional_modes(&self) -> Vec<TorsionalMode> {
        self.tool().torsional_modes(SHOWN_MODES)
    }

    /// Warns of a mode above the first that decays slower than the window of the stick-slip index is long: the index and its
    /// alarm then outlast their cause, so that the driller lowers the weight against a swing that no weight feeds.
    fn warn_of_ringing(&self, warnings: &mut Vec<String>) {
        let (modes, window) = (self.torsional_modes(), self.stick_slip.window);
        let lasts = |mode: &TorsionalMode| mode.decay * window < 1.0;
        let Some((index, mode)) = modes.iter().enumerate().skip(1).find(|(_, mode)| lasts(mode)) else {
            return;
        };
        let time = if mode.decay > LEAST_DECAY {
            format!("decays in {:.0} s, longer than", 1.0 / mode.decay)
        } else {
            "does not decay within".to_owned()
        };
        let why = if modes[..index].iter().any(lasts) {
            "neither the drive nor the string damps it"
        } else {
            "the drive's tuning damps only the modes below"
        };
        warnings.push(format!(
            "the torsional mode of top drive, string and tool at {:.2} Hz {time} the {window} s of stick_slip.window: {why}. The bit goes on swinging after its cause is gone, and a bit torque that falls with the speed makes it stick; give string.attenuation_per_km, or tune string.top_drive",
            mode.frequency / std::f64::consts::TAU
        ));
    }

    /// Warnings as sentences, most important first.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        self.warn_of_joint_limit(&mut warnings);
        self.warn_of_sagitta(&mut warnings);
        self.warn_of_short_contacts(&mut warnings);
        self.warn_of_play(&mut warnings);
        self.warn_of_yield(&mut warnings);
        warnings.extend(self.guide_that_rings());
        self.warn_of_ringing(&mut warnings);
        self.warn_of_mud(&mut warnings);
        self.warn_of_idle_factors(&mut warnings);
        let off_mesh = self.tool.pipe.pieces_off_mesh(self.tool.elements_per_link);
        if !off_mesh.is_empty() {
            warnings.push(format!(
                "tool.pipe.pieces end at {off_mesh:?} of the link, inside an element; each of the {} elements takes the piece at its middle",
                self.tool.elements_per_link
            ));
        }
        let (bit, hole) = (self.tool.bit.diameter, self.well.hole_diameter);
        if (bit - hole).abs() > 0.02 * hole {
            warnings.push(format!(
                "tool.bit.diameter {bit} m and well.hole_diameter {hole} m differ by more than 2 %: a bit cuts its own diameter"
            ));
        }
        for (name, rate) in self.rates() {
            if rate * self.solver.time_step > 1.0 {
                warnings.push(format!(
                    "outputs.rates.{name} {rate} Hz is faster than the model's step of {} s",
                    self.solver.time_step
                ));
            }
        }
        if self.whirl.sample_rate * self.solver.time_step > 1.0 {
            warnings.push(format!(
                "whirl.sample_rate {} Hz is faster than the model's step of {} s",
                self.whirl.sample_rate, self.solver.time_step
            ));
        }
        warnings.extend(HardBounds::overridden(self));
        warnings
    }

    fn warn_of_mud(&self, warnings: &mut Vec<String>) {
        let Some(mud) = &self.environment.mud else {
            return;
        };
        let (buoyancy, steel) = (self.environment.buoyancy_factor, self.tool.material.density);
        let floating = 1.0 - mud.density / steel;
        if self.environment.gravity > 0.0 && (floating - buoyancy).abs() > 0.01 {
            warnings.push(format!(
                "environment.mud.density {} kg/m3 belongs to a buoyancy factor of {floating:.3}, not to environment.buoyancy_factor {buoyancy}",
                mud.density
            ));
        }
        if mud.added_mass != AddedMass::None
            && self
                .masses
                .iter()
                .any(|mass| mass.at.location(&self.mesh()) == Location::All)
        {
            warnings.push(
                "masses at all stations and environment.mud.added_mass both add mass along the tool: leave out masses that stand for mud".to_owned(),
            );
        }
    }

    fn warn_of_idle_factors(&self, warnings: &mut Vec<String>) {
        let (well, factors) = (self.well.describe(), self.contact.wall_friction_factors.describe());
        for interval in HoleInterval::ALL {
            let (factor, key) = (factors.of(interval), WallFrictionFactors::key(interval));
            if factor != 1.0 && !well.has(interval) {
                let missing = match interval {
                    HoleInterval::BeforeArc => "no straight section before its first arc",
                    HoleInterval::Arc => "no arc",
                    HoleInterval::AfterArc => "no straight section after an arc",
                };
                warnings.push(format!(
                    "contact.wall_friction_factors.{key} {factor} acts nowhere: well.sections has {missing}"
                ));
            }
        }
    }

    fn rates(&self) -> [(&'static str, f64); 3] {
        let rates = &self.outputs.rates;
        [
            ("joint_deflections", rates.joint_deflections),
            ("contact_forces", rates.contact_forces),
            ("bit_state", rates.bit_state),
        ]
    }

    fn warn_of_joint_limit(&self, warnings: &mut Vec<String>) {
        let (limit, needed) = (self.tool.joint.limit_deg, self.build_angle_per_link_deg());
        if self.tool.links < 2 {
            return;
        }
        if limit <= needed {
            warnings.push(format!(
                "tool.joint.limit_deg {limit} deg is not above the {needed:.2} deg that each joint must take in the arc: all stops carry load from the start; take more links or a larger limit"
            ));
        }
        // A link that lies diagonally in the gap bends both its joints.
        let lean = rad_to_deg((2.0 * self.inner_clearance() / self.link_length()).atan());
        if limit > needed + 2.0 * lean && limit < 45.0 {
            warnings.push(format!(
                "tool.joint.limit_deg {limit} deg can hardly be reached: the gap lets a joint bend to about {:.1} deg",
                needed + 2.0 * lean
            ));
        }
    }

    fn warn_of_short_contacts(&self, warnings: &mut Vec<String>) {
        let (step, duration) = (self.solver.time_step, self.contact_duration());
        if duration < FEWEST_STEPS * step {
            warnings.push(format!(
                "contact.inner.stiffness {:.3e} N/m throws a node of the pipe back after {:.2} ms, {:.2} steps of solver.time_step {step} s; below {FEWEST_STEPS} steps collisions may feed the motion (model_quality in twin/status): take a step below {:.2e} s, or a softer contact",
                self.contact.inner.stiffness,
                1e3 * duration,
                duration / step,
                duration / FEWEST_STEPS
            ));
        }
    }

    fn warn_of_play(&self, warnings: &mut Vec<String>) {
        let Solver { time_step, step, .. } = self.solver;
        let taken = match step {
            StepTaken::Fixed => time_step,
            StepTaken::Auto => 0.5 * time_step,
        };
        if self.tool.joint.play_deg > 0.0 && taken > LONGEST_WITH_PLAY {
            warnings.push(format!(
                "tool.joint.play_deg {} deg: in steps of {taken} s its contacts close within a step while the tool starts to turn, and model_quality is poor for the first seconds; take solver.step: auto with solver.time_step at most {} s, or fixed steps of at most {LONGEST_WITH_PLAY} s",
                self.tool.joint.play_deg,
                2.0 * LONGEST_WITH_PLAY
            ));
        }
    }

    fn warn_of_yield(&self, warnings: &mut Vec<String>) {
        let strain = self.guide_bending_strain();
        if strain <= YIELD_STRAIN || self.tool.guide.fixed {
            return;
        }
        if let Some(close_at) = self.tool.guide.slots_close_at() {
            warnings.push(format!(
                "tool.guide.slots_close_at: bent into the hole, the guide closes its slots at {close_at} 1/m and is strained by {:.2} % beyond, above the {:.2} % at which S-135 drill pipe yields: it would keep the bend or break; wider slots close later",
                100.0 * strain,
                100.0 * YIELD_STRAIN,
            ));
        } else {
            let guide = &self.tool.guide;
            let made = guide.made();
            let curvatures: Vec<String> = made.iter().map(|piece| format!("{:.4} 1/m", piece.curvature)).collect();
            let (made, cure) = match made.len() {
                1.. => (
                    format!("made with {}", curvatures.join(", ")),
                    "a curvature between that of the arc and a straight hole (tool.guide.free_curvature)",
                ),
                0 => (
                    "that was made with the curvature of the arc".to_owned(),
                    "tool.guide.free_curvature as it was really made",
                ),
            };
            warnings.push(format!(
                "tool.guide: on its way through the straight hole and the arc, a guide {made} is strained by {:.2} % at its outermost bent fibre, {} m from the neutral line, beyond the {:.2} % at which S-135 drill pipe yields: it would keep the bend or break; give {cure}, and for a slotted guide the ribs between its slots (tool.guide.outer_fibre)",
                100.0 * strain,
                guide.outer_fibre(),
                100.0 * YIELD_STRAIN,
            ));
        }
    }

    /// The warning of a soft guide that nothing calms on the wall: its stations ring there by themselves, which takes friction
    /// off the guide, more so in finer steps. The weight at the bit then depends on the step, which the balances of energy
    /// behind the model quality do not show: each step solves its equations. None for any other guide.
    pub fn guide_that_rings(&self) -> Option<String> {
        let (guide, outer) = (&self.tool.guide, &self.contact.outer);
        let has_film = self
            .environment
            .mud
            .as_ref()
            .is_some_and(|mud| mud.film != MudFilm::None);
        // Only a guide that advances loses weight to the wall; `separate` has the paper's guide, which does not.
        if guide.fixed || has_film || outer.friction == FrictionLaw::Separate {
            return None;
        }
        let section = SectionProperties::of(guide.section(), self.tool.material.describe(), guide.bending_factor);
        let spacing = self.link_length() / self.tool.elements_per_link as f64;
        // A beam on springs, k per spacing: its bending length is (4 EI / (k / spacing))^(1/4).
        let bending_length = (4.0 * section.bending * spacing / outer.stiffness).powf(0.25);
        if bending_length >= LONE_STATIONS * spacing {
            return None;
        }
        // The contact damps by c = d F: the more, the harder the station is pressed.
        let weight = section.mass * self.environment.gravity * self.environment.buoyancy_factor;
        let pressed = (weight + JUDGED_THRUST / self.well.smallest_radius()) * spacing;
        let critical = 2.0 * (outer.stiffness * section.mass * spacing).sqrt();
        let ratio = outer.damping * pressed / critical;
        (ratio < LEAST_DAMPING).then(|| {
            format!(
                "contact.outer.damping {} s/m: on the wall each station of this soft guide vibrates by itself, damped by {:.1} % of critical under a thrust of {:.0} kN. It rings, which takes friction off the guide, and what arrives at the bit then depends on the step; give at least {:.0} s/m, or environment.mud.film: squeeze",
                outer.damping,
                100.0 * ratio,
                1e-3 * JUDGED_THRUST,
                (LEAST_DAMPING * critical / pressed).ceil()
            )
        })
    }

    fn warn_of_sagitta(&self, warnings: &mut Vec<String>) {
        let (sagitta, clearance) = (self.chord_sagitta(), self.inner_clearance());
        if sagitta > clearance {
            warnings.push(format!(
                "a straight link of {:.3} m does not fit into the curved guide: its chord lies {:.1} mm off the centre line, the clearance is {:.1} mm; take more links",
                self.link_length(),
                sagitta * 1e3,
                clearance * 1e3
            ));
        }
        let tilt = deg_to_rad(self.build_angle_per_link_deg());
        if tilt > 0.2 {
            warnings.push(format!(
                "a link turns by {:.1} deg in the arc: tilts are not small any more",
                rad_to_deg(tilt)
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn default_tool() -> Config {
        Config::load("../../config/default.yaml").unwrap()
    }

    fn short_contacts(config: &Config) -> Vec<String> {
        let mut warnings = Vec::new();
        config.warn_of_short_contacts(&mut warnings);
        warnings
    }

    #[test]
    fn contacts_too_short_for_the_step_are_warned_of() {
        let stiff = default_tool().with_value("contact.inner.stiffness", 3e7).unwrap();
        let warnings = short_contacts(&stiff);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        // 63 x 32 mm of steel, 152 mm in five elements: 0.553 kg; pi sqrt(m / k) = 0.427 ms.
        for part in [
            "contact.inner.stiffness 3.000e7 N/m",
            "0.43 ms",
            "0.85 steps",
            "below 3.88e-4 s",
        ] {
            assert!(warnings[0].contains(part), "'{part}' is not in {}", warnings[0]);
        }
        let finer = stiff.with_value("solver.time_step", 3.8e-4).unwrap();
        assert!(short_contacts(&finer).is_empty());
    }

    #[test]
    fn a_soft_guide_that_rings_on_the_wall_is_warned_of() {
        let rings = |changes: &[(&str, serde_json::Value)]| {
            let rig = Config::load("../../config/rig.yaml").unwrap();
            rig.with_values("test", changes.iter().cloned())
                .unwrap()
                .guide_that_rings()
        };
        assert_eq!(rings(&[]), None);
        let dry = ("contact.outer.damping", 0.5.into());
        let warning = rings(std::slice::from_ref(&dry)).unwrap();
        // 24.69 kg/m of steel in stations of 30.5 mm: critical 2 sqrt(2e7 x 0.752) = 7758 N s/m; pressed by 208 N/m and
        // 10 kN over 3.2 m, 101.6 N.
        for part in ["damping 0.5 s/m", "0.7 % of critical", "10 kN", "at least 4 s/m"] {
            assert!(warning.contains(part), "'{part}' is not in {warning}");
        }
        for cure in [
            ("environment.mud.film", "squeeze".into()),
            ("tool.guide.bending_factor", 0.05.into()),
            ("contact.outer.friction", "separate".into()),
        ] {
            assert_eq!(rings(&[dry.clone(), cure.clone()]), None, "{cure:?}");
        }
    }

    #[test]
    fn a_factor_of_an_interval_that_the_hole_does_not_have_is_warned_of() {
        let idle = |key: &str, factor: f64| {
            let key = format!("contact.wall_friction_factors.{key}");
            let mut warnings = Vec::new();
            let config = default_tool().with_value(&key, factor).unwrap();
            config.warn_of_idle_factors(&mut warnings);
            warnings
        };
        assert!(idle("arc", 2.0).is_empty() && idle("after_arc", 1.0).is_empty());
        assert_eq!(
            idle("after_arc", 1.5),
            [
                "contact.wall_friction_factors.after_arc 1.5 acts nowhere: well.sections has no straight section after an arc"
            ]
        );
        assert_eq!(idle("before_arc", 0.5).len(), 1);
    }

    #[test]
    fn play_in_steps_that_are_too_long_for_it_is_warned_of() {
        let warned = |config: &Config| {
            let mut warnings = Vec::new();
            config.warn_of_play(&mut warnings);
            warnings
        };
        let worn = default_tool().with_value("tool.joint.play_deg", 0.5).unwrap();
        // `auto` takes halves of 0.5 ms at least.
        assert!(warned(&worn).is_empty());
        let fixed = worn.with_value("solver.step", "fixed").unwrap();
        let warnings = warned(&fixed);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        for part in ["tool.joint.play_deg 0.5 deg", "steps of 0.0005 s", "at most 0.00025 s"] {
            assert!(warnings[0].contains(part), "'{part}' is not in {}", warnings[0]);
        }
        assert!(warned(&fixed.with_value("solver.time_step", 2.5e-4).unwrap()).is_empty());
        assert_eq!(warned(&worn.with_value("solver.time_step", 1e-3).unwrap()).len(), 1);
        assert!(warned(&fixed.with_value("tool.joint.play_deg", 0.0).unwrap()).is_empty());
    }

    #[test]
    fn a_guide_that_yields_in_the_hole_is_warned_of() {
        let yields = |config: &Config| {
            let mut warnings = Vec::new();
            config.warn_of_yield(&mut warnings);
            warnings
        };
        // Without stress in the arc, but not in the straight hole above: 51 mm / 3.2 m.
        let warnings = yields(&default_tool());
        for part in ["made with the curvature of the arc", "1.59 %", "tool.guide.outer_fibre"] {
            assert!(warnings[0].contains(part), "'{part}' is not in {}", warnings[0]);
        }
        assert!(yields(&default_tool().with_value("tool.guide.fixed", true).unwrap()).is_empty());
        let straight = default_tool().with_value("tool.guide.free_curvature", 0.0).unwrap();
        let warnings = yields(&straight);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        // 51 mm / 3.2 m.
        for part in ["tool.guide.free_curvature", "1.59 %", "0.45 %", "made with 0.0000 1/m"] {
            assert!(warnings[0].contains(part), "'{part}' is not in {}", warnings[0]);
        }
        // Above the arc it is bent by 0.23 x 51 mm = 1.17 %, and with ribs that reach 19 mm out by 0.44 %.
        let bent = straight.with_value("tool.guide.free_curvature", 0.23).unwrap();
        assert!(yields(&bent)[0].contains("1.17 %"));
        let ribs = r#"
well: {sections: [{arc: {radius: 3.2, build_angle_deg: 90}}], hole_diameter: 0.118}
tool:
  links: 33
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080, free_curvature: 0.23, outer_fibre: 0.019}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118}
"#;
        let ribs = Config::from_text("ribs", ribs).unwrap();
        assert!(yields(&ribs).is_empty());
        // Slots that close at 0.25 1/m leave (1/3.2 - 0.25) x 51 mm = 0.32 % to the tube, at 0.2 1/m 0.57 %.
        let slotted = straight.with_value("tool.guide.bending_factor", 0.05).unwrap();
        let closing = |at: f64| {
            yields(
                &slotted
                    .with_value("tool.guide.slots_close_at", serde_json::json!(at))
                    .unwrap(),
            )
        };
        assert!(closing(0.25).is_empty());
        let warnings = closing(0.2);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        for part in ["tool.guide.slots_close_at", "0.2 1/m", "0.57 %", "0.45 %"] {
            assert!(warnings[0].contains(part), "'{part}' is not in {}", warnings[0]);
        }
        // Against the build the same bend is an addition.
        let turned = r#"[{"at": "top", "body": "guide", "fix": ["psi"]}]"#;
        let turned: serde_json::Value = serde_json::from_str(turned).unwrap();
        let against = [
            ("boundary.supports", turned),
            ("tool.guide.free_curvature_phase_deg", 180.0.into()),
        ];
        assert_eq!(yields(&ribs.with_values("test", against).unwrap()).len(), 1);
    }

    #[test]
    fn the_default_tool_is_not_warned_of_until_its_step_grows() {
        let config = default_tool();
        assert!(short_contacts(&config).is_empty());
        let doubled = config.with_value("solver.time_step", 1e-3).unwrap();
        assert_eq!(short_contacts(&doubled).len(), 1);
    }
}
