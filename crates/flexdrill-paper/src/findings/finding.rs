//! Comparison of one finding of the paper with ours: number, location, ratio or period.

/// Whether our result agrees with a finding of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Yes; a number within 20 %.
    Agrees,
    /// In part; a number within a factor of two.
    Partly,
    /// No.
    No,
}

impl Verdict {
    /// The word in the report.
    pub fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Partly => "partly",
            Self::No => "no",
        }
    }
}

/// One finding.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Finding {
    /// Short name, for tables.
    pub key: &'static str,
    /// The paper's figure.
    pub figure: &'static str,
    /// What the paper found.
    pub paper: &'static str,
    /// What is measured here.
    pub definition: &'static str,
    /// Our number, in the unit of the definition.
    pub value: f64,
    /// What was found here, in words and numbers.
    pub ours: String,
    /// Whether they agree.
    pub verdict: Verdict,
    /// Why (not).
    pub why: String,
    /// Closeness for the search, 0 to 1: 1 agrees.
    pub closeness: f64,
}

/// A number within this factor of the paper's agrees: the paper's parameters are unpublished and the motion is chaotic.
const AGREES: f64 = 1.2;
/// Within this factor it agrees partly.
const PARTLY: f64 = 2.0;
/// From this factor on its closeness is 0.
const FAR: f64 = 100.0;
/// A location agrees within (deg): two links.
const PLACE_AGREES: f64 = 5.0;
/// And partly within (deg).
const PLACE_PARTLY: f64 = 15.0;
/// Autocorrelation from which a history counts as periodic.
const PERIODIC: f64 = 0.3;
/// Largest closeness of a finding that does not agree.
const NEAR_MISS: f64 = 0.9;

/// The paper's statement, for [`number`] and similar functions.
pub(super) struct Paper {
    pub(super) key: &'static str,
    pub(super) figure: &'static str,
    pub(super) says: &'static str,
    pub(super) definition: &'static str,
}

/// A positive number against the paper's.
pub(super) fn number(paper: Paper, unit: &str, digits: usize, value: f64, expected: f64) -> Finding {
    let ratio = value / expected;
    let off = if ratio > 0.0 {
        ratio.max(1.0 / ratio)
    } else {
        f64::INFINITY
    };
    let verdict = if off <= AGREES {
        Verdict::Agrees
    } else if off <= PARTLY {
        Verdict::Partly
    } else {
        Verdict::No
    };
    let why = match verdict {
        Verdict::Agrees => format!("{:+.0} %, within 20 %", 100.0 * (ratio - 1.0)),
        Verdict::Partly => format!("{ratio:.2} of the paper's, within a factor of 2"),
        Verdict::No => format!("{ratio:.3} of the paper's"),
    };
    let closeness = closeness(verdict, 1.0 - off.ln() / FAR.ln());
    finding(
        paper,
        value,
        format!("{value:.digits$} {unit}"),
        verdict,
        why,
        closeness,
    )
}

/// A location (deg) against the paper's.
pub(super) fn place(paper: Paper, value: f64, expected: f64) -> Finding {
    let off = (value - expected).abs();
    let verdict = if off <= PLACE_AGREES {
        Verdict::Agrees
    } else if off <= PLACE_PARTLY {
        Verdict::Partly
    } else {
        Verdict::No
    };
    let why = format!("{off:.1} degrees from the paper's place");
    let closeness = closeness(verdict, 1.0 - off / 90.0);
    finding(paper, value, format!("{value:.1} deg"), verdict, why, closeness)
}

/// 1 for what agrees, at most [`NEAR_MISS`] otherwise.
pub(super) fn closeness(verdict: Verdict, near: f64) -> f64 {
    match verdict {
        Verdict::Agrees => 1.0,
        Verdict::Partly | Verdict::No => NEAR_MISS * near.clamp(0.0, 1.0),
    }
}

/// A finding whose verdict is known.
pub(super) fn finding(
    paper: Paper,
    value: f64,
    ours: String,
    verdict: Verdict,
    why: String,
    closeness: f64,
) -> Finding {
    Finding {
        key: paper.key,
        figure: paper.figure,
        paper: paper.says,
        definition: paper.definition,
        value,
        ours,
        verdict,
        why,
        closeness,
    }
}

/// Three levels of a ratio: agrees from the first, partly from the second.
pub(super) fn ratio(paper: Paper, ours: String, value: f64, [agrees, partly]: [f64; 2], why: &str) -> Finding {
    let verdict = if value >= agrees {
        Verdict::Agrees
    } else if value >= partly {
        Verdict::Partly
    } else {
        Verdict::No
    };
    let why = format!("{why}: {value:.2}; agrees from {agrees}, partly from {partly}");
    finding(paper, value, ours, verdict, why, closeness(verdict, value / agrees))
}

/// A period against the paper's; a history that hardly repeats itself has none.
pub(super) fn periodic(paper: Paper, period: f64, strength: f64, expected: f64) -> Finding {
    let mut found = number(paper, "s", 2, period, expected);
    found.ours = format!("{period:.2} s, autocorrelation {strength:.2}");
    if strength < PERIODIC && found.verdict != Verdict::No {
        found.verdict = Verdict::No;
        found.why = format!("hardly periodic: autocorrelation {strength:.2}, periodic from {PERIODIC}");
    }
    if found.verdict != Verdict::Agrees {
        found.closeness = found.closeness.min(NEAR_MISS) * (0.5 + 0.5 * strength.clamp(0.0, 1.0));
    }
    found
}
