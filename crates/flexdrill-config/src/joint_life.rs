//! `tool.joint.life` and `tool.joint.serial_numbers`: the class of the joints' details, by which counted load cycles
//! become a damage, and which joint is which.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::section::section;
use super::{Config, Pipe};
use flexdrill_motion::{AgeingSettings, Detail, Woehler};

/// IIW's classes are 36 to 160 MPa; a detail outside twice that range has no class.
const FAT: Bound = Bound::within(15.0, 320.0);
const SLOPE: Bound = Bound::within(2.0, 10.0);
/// A cube of some centimetres.
const SECTION_MODULUS: Bound = Bound::above(0.0, 1e-2);
/// Cycles at which IIW's classes are named.
const CYCLES_OF_FAT: f64 = 2e6;
/// Cycles at the knee in air, of DNVGL-RP-C203 and of IIW's classes.
const CYCLES_OF_KNEE: f64 = 1e7;
/// Slope beyond the knee, of the same.
const SLOPE_BELOW_KNEE: f64 = 5.0;
/// Part of a class's stress range in a corrosive environment, after IIW.
const CORRODED: f64 = 0.7;
/// Longest serial number (characters).
const LONGEST: usize = 40;

section! {
    /// The class of the joints' details, for their life. It changes nothing of the motion. With it `twin/ageing` counts
    /// cycles with the slopes of the class, and `flexdrill life` makes damages of them. Default none.
    #[derive(Copy)]
    pub struct JointLife(this) {
        /// Detail category of DNVGL-RP-C203 (2016): `B1` is a machined part without a weld, `D` a good butt weld, `W3` the
        /// root of a weld. Required without `fat`.
        #[serde(skip_serializing_if = "Option::is_none")]
        class: Option<DetailClass> = None;
        /// In place of `class`: stress range at 2e6 cycles, with which 97.7 % survive, as IIW and Eurocode 3 name their
        /// classes (MPa).
        ///
        /// Allowed: within 15 to 320 MPa
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = FAT.in_schema())]
        fat: Option<f64> = None;
        /// Slope of the line that `fat` gives: 3 for welds, 5 for machined steel. With `fat` only. Default 3.
        ///
        /// Allowed: within 2 to 10
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = SLOPE.in_schema())]
        fat_slope: Option<f64> = None;
        /// What surrounds the joint: `free_corrosion`, as in water-based mud, or `air`, as in an oil that keeps water off.
        environment: LifeEnvironment = LifeEnvironment::FreeCorrosion;
        /// Standard deviation of log10 of the cycles to a crack, at one stress range.
        scatter: f64 = 0.2, within(0.0, 1.0), "", "0.2 is that of tests behind the printed lines; 1 is a factor of 100 to both sides";
        /// Stress that the class refers to, over the bending stress of the section.
        stress_concentration: f64 = 1.0, within(0.2, 20.0), "", "1 is a plain section; a sharp thread has 5";
        /// Standard deviation of `stress_concentration`, as a share of it.
        stress_concentration_scatter: f64 = 0.2, within(0.0, 1.0), "", "0.2 is an estimate by hand; 0.05 a fine mesh";
        /// Section modulus of what carries the moment of a joint's stop (m3). Default that of the thinnest piece of a link.
        ///
        /// Allowed: above 0, at most 0.01 m3
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = SECTION_MODULUS.in_schema())]
        stop_section_modulus: Option<f64> = None;
        /// Part of a life after which a joint is listed for inspection, as its inverse: 3 lists it at a third, judged by the
        /// 95 % of its damage.
        design_factor: f64 = 3.0, within(1.0, 100.0), "", "1 is a whole life; offshore 10 stands for what is never inspected";
    }
}

/// What surrounds a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LifeEnvironment {
    /// Seawater or mud on bare steel: no knee, at any number of cycles.
    FreeCorrosion,
    /// Dry, or an oil.
    Air,
}

impl LifeEnvironment {
    /// As in a file.
    pub fn word(self) -> &'static str {
        match self {
            Self::FreeCorrosion => "free_corrosion",
            Self::Air => "air",
        }
    }
}

/// The classes with the constants of DNVGL-RP-C203 (2016): log10 of the cycles at 1 MPa and slope in air (table 2-1), and
/// the constant in free corrosion (table 2-4), where all slopes are 3.
macro_rules! classes {
    ($($name:ident: $air:literal, $slope:literal, $corroded:literal;)*) => {
        /// A detail category of DNVGL-RP-C203.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
        pub enum DetailClass {
            $(#[doc = concat!("Category ", stringify!($name), ".")] $name,)*
        }

        impl DetailClass {
            /// All, best first.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// Its name in the standard.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$name => stringify!($name),)*
                }
            }

            /// Constant and slope in air, constant in free corrosion.
            const fn constants(self) -> (f64, f64, f64) {
                match self {
                    $(Self::$name => ($air, $slope, $corroded),)*
                }
            }
        }
    };
}

classes! {
    B1: 15.117, 4.0, 12.436;
    B2: 14.885, 4.0, 12.262;
    C: 12.592, 3.0, 12.115;
    C1: 12.449, 3.0, 11.972;
    C2: 12.301, 3.0, 11.824;
    D: 12.164, 3.0, 11.687;
    E: 12.010, 3.0, 11.533;
    F: 11.855, 3.0, 11.378;
    F1: 11.699, 3.0, 11.222;
    F3: 11.546, 3.0, 11.068;
    G: 11.398, 3.0, 10.921;
    W1: 11.261, 3.0, 10.784;
    W2: 11.107, 3.0, 10.630;
    W3: 10.970, 3.0, 10.493;
}

impl JointLife {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        match (self.class, self.fat) {
            (None, None) => c.wrong(
                "class",
                "left out",
                "",
                "a detail category such as F1, or `fat`",
                "without a class cycles are no part of a life",
            ),
            (Some(_), Some(fat)) => c.wrong(
                "fat",
                fat,
                "MPa",
                "left out with tool.joint.life.class",
                "a detail has one class",
            ),
            _ => {}
        }
        if let Some(fat) = self.fat {
            c.number("fat", fat, FAT, "MPa", "IIW has classes of 36 to 160 MPa");
        }
        if let Some(slope) = self.fat_slope {
            c.number("fat_slope", slope, SLOPE, "", "3 for welds, 5 for machined steel");
            c.require(
                self.fat.is_some(),
                "fat_slope",
                slope,
                "",
                "left out without tool.joint.life.fat",
                "a detail category has its own slope",
            );
        }
        if let Some(modulus) = self.stop_section_modulus {
            let reason = "in m3; a round bar of 50 mm has 1.2e-5";
            c.number("stop_section_modulus", modulus, SECTION_MODULUS, "m3", reason);
        }
    }

    /// The mean line of the class.
    pub fn line(&self) -> Woehler {
        let free = self.environment == LifeEnvironment::FreeCorrosion;
        let (air, slope, corroded) = match self.class {
            Some(class) => class.constants(),
            None => {
                let (fat, slope) = (self.fat.unwrap_or(f64::NAN), self.fat_slope.unwrap_or(3.0));
                let at = |range: f64| CYCLES_OF_FAT.log10() + slope * range.log10();
                (at(fat), slope, at(CORRODED * fat))
            }
        };
        match (free, self.class) {
            // All categories have a slope of 3 there.
            (true, Some(_)) => Woehler::from_design(corroded, 3.0, self.scatter),
            (true, None) => Woehler::from_design(corroded, slope, self.scatter),
            // A line that is as flat above its knee as below it has none.
            (false, _) if slope >= SLOPE_BELOW_KNEE => Woehler::from_design(air, slope, self.scatter),
            (false, _) => Woehler::from_design(air, slope, self.scatter).with_knee(CYCLES_OF_KNEE, SLOPE_BELOW_KNEE),
        }
    }

    /// The class in words, such as `DNVGL-RP-C203 F1`.
    pub fn class_in_words(&self) -> String {
        match (self.class, self.fat) {
            (Some(class), _) => format!("DNVGL-RP-C203 {}", class.name()),
            (None, Some(fat)) => format!("FAT {fat} with a slope of {}", self.fat_slope.unwrap_or(3.0)),
            (None, None) => "no class".to_owned(),
        }
    }

    /// The details of a joint: its stop, and the middle of the link below it.
    pub(super) fn details(&self, pipe: &Pipe, elements: usize) -> [Detail; 2] {
        let moduli: Vec<f64> = (pipe.element_sections(elements).iter())
            .map(|tube| {
                let [outer, inner] = [tube.outer_diameter, tube.inner_diameter].map(|diameter| diameter.powi(4));
                std::f64::consts::PI * (outer - inner) / (32.0 * tube.outer_diameter)
            })
            .collect();
        let thinnest = moduli.iter().copied().fold(f64::INFINITY, f64::min);
        // The twin samples the bending of this element.
        let middle = moduli[(elements - 1) / 2];
        [self.stop_section_modulus.unwrap_or(thinnest), middle].map(|section_modulus| Detail {
            line: self.line(),
            section_modulus,
            stress_concentration: self.stress_concentration,
            stress_concentration_scatter: self.stress_concentration_scatter,
        })
    }
}

impl Config {
    /// The details of a joint whose damage is known: its stop, and the middle of the link below it. None without
    /// `tool.joint.life`.
    pub fn joint_details(&self) -> Option<[Detail; 2]> {
        let life = self.tool.joint.life.as_ref()?;
        Some(life.details(&self.tool.pipe, self.tool.elements_per_link))
    }

    /// How load cycles are counted: with the slopes of the joints' class, else with `joint_load.woehler_slope`.
    pub(super) fn ageing(&self) -> AgeingSettings {
        let mut settings = self.joint_load.describe_ageing();
        if let Some(details) = self.joint_details() {
            [settings.slope, settings.slope_below_knee] = details[0].line.slopes();
            settings.knees = details.map(|detail| detail.knee_moment() / settings.rated_moment);
        }
        settings
    }
}

/// Checks the serial numbers of `joints` joints.
pub(super) fn check_serial_numbers(c: &mut Checker, serials: &[String], joints: usize) {
    if serials.is_empty() {
        return;
    }
    c.require(
        serials.len() == joints,
        "serial_numbers",
        serials.len(),
        "",
        format!("{joints} serial numbers, one per joint: tool.links - 1"),
        "the first is that of the joint next to the bit, the last that of the uppermost",
    );
    let mut seen = BTreeSet::new();
    c.below("serial_numbers", |c| {
        for (index, serial) in serials.iter().enumerate() {
            let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./".contains(letter);
            c.require(
                !serial.is_empty() && serial.chars().count() <= LONGEST && serial.chars().all(plain),
                &index.to_string(),
                serial,
                "",
                format!("1 to {LONGEST} of the letters A to Z, a to z, digits, and - _ . /"),
                "it stands in a table, and is read on steel",
            );
            c.require(
                seen.insert(serial),
                &index.to_string(),
                serial,
                "",
                "another serial number than those before it",
                "a joint is in one place of the tool",
            );
        }
    });
}
