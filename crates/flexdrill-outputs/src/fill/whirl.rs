//! [`WhirlState`] and [`WhirlWarning`].

use super::copy;
use flexdrill_core::tool::Body;
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::{n_to_kn, rad_to_deg};
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{WhirlState, WhirlWarning};
use flexdrill_motion::{DriveState, Severity, WhirlKind, WhirlWarningLevel};

fn body_code(body: Body) -> u8 {
    match body {
        Body::Pipe => WhirlState::PIPE,
        Body::Guide => WhirlState::GUIDE,
    }
}

/// Fills `out`.
pub fn whirl_state(snapshot: &Snapshot, header: &Header, out: &mut WhirlState) {
    super::stamp(&mut out.header, header);
    let whirl = &snapshot.whirl;
    copy(&mut out.measured_depth, &whirl.measured_depth);
    copy(&mut out.inclination, &whirl.inclination);
    out.body.clear();
    out.body.extend(whirl.body.iter().map(|body| body_code(*body)));
    out.kind.clear();
    out.kind.extend(whirl.kind.iter().map(|kind| *kind as u8));
    copy(&mut out.whirl_rate, &whirl.whirl_rate);
    copy(&mut out.whirl_ratio, &whirl.whirl_ratio);
    copy(&mut out.orbit_radius, &whirl.orbit_radius);
    copy(&mut out.clearance_ratio, &whirl.clearance_ratio);
    copy(&mut out.contact_duty, &whirl.contact_duty);
    copy(&mut out.confidence, &whirl.confidence);
    out.severity.clear();
    out.severity
        .extend(whirl.severity.iter().map(|severity| *severity as u8));
    copy(&mut out.rolling_share, &whirl.rolling_share);
    copy(&mut out.gap_turns, &whirl.gap_turns);
    copy(&mut out.bending_cycles, &whirl.bending_cycles);
    copy(&mut out.impulse, &whirl.impulse);
    copy(&mut out.impact_rate, &whirl.impact_rate);
    copy(&mut out.friction_power, &whirl.friction_power);
}

/// Whether a level stands that means nothing, as the drive does not turn steadily: the whirl alarms are suppressed by
/// design then, and the warning is OK.
pub fn whirl_warning_is_suppressed(snapshot: &Snapshot) -> bool {
    snapshot.warning.severity != Severity::Ok && snapshot.hazards.drive != DriveState::Turning
}

/// Fills `out`. `input_quality` is the worse of the inputs' states, in the message's INPUT_ constants.
pub fn whirl_warning(snapshot: &Snapshot, header: &Header, input_quality: u8, out: &mut WhirlWarning) {
    super::stamp(&mut out.header, header);
    let (level, whirl) = (&snapshot.warning, &snapshot.whirl);
    let body = whirl.body.get(level.entry).copied().unwrap_or_default();
    let suppressed = whirl_warning_is_suppressed(snapshot);
    let severity = if suppressed { Severity::Ok } else { level.severity };
    out.severity = severity as u8;
    out.kind = level.kind as u8;
    out.body = body_code(body);
    out.measured_depth = whirl.measured_depth.get(level.entry).copied().unwrap_or_default();
    out.inclination = whirl.inclination.get(level.entry).copied().unwrap_or_default();
    out.whirl_ratio = level.whirl_ratio;
    out.clearance_ratio = level.clearance_ratio;
    out.contact_duty = level.contact_duty;
    out.window = level.window;
    out.since = header.stamp.plus_seconds(level.since - snapshot.time);
    out.input_quality = input_quality;
    out.sequence = level.sequence;
    out.peak_force = level.peak_force;
    out.rolling_share = level.rolling_share;
    out.confidence = level.confidence;
    out.message = if suppressed {
        "No whirl warning: the drive is at standstill or starting.".to_owned()
    } else {
        sentence(out, level, body)
    };
    if let Some(doubt) = doubt(input_quality) {
        out.message.push(' ');
        out.message.push_str(doubt);
    }
}

/// What a person reads.
fn sentence(warning: &WhirlWarning, level: &WhirlWarningLevel, body: Body) -> String {
    if level.severity == Severity::Ok {
        return "No whirl warning.".to_owned();
    }
    let severity = capitalized(level.severity.name());
    let kind = match level.kind {
        WhirlKind::None => "large lateral motion",
        kind => kind.name(),
    };
    let body = match body {
        Body::Pipe => "flexible pipe",
        Body::Guide => "guide pipe",
    };
    let manner = match level.rolling_share {
        share if share <= 0.0 => String::new(),
        share if level.rolling => format!(", rolling ({:.0} % of the rate without slip)", 100.0 * share),
        share => format!(", sliding ({:.0} % of the rate without slip)", 100.0 * share),
    };
    let rate = match warning.whirl_ratio {
        ratio if ratio.is_nan() => String::new(),
        ratio => format!(", whirl rate {ratio:.1} times the rotary speed"),
    };
    format!(
        "{severity}: {kind} of the {body} at {:.2} m (inclination {:.0} deg){rate}{manner}, {:.0} % of the clearance, \
         in contact {:.0} % of the last {:.1} s with up to {:.2} kN, confidence {:.0} %.",
        warning.measured_depth,
        rad_to_deg(warning.inclination),
        100.0 * warning.clearance_ratio,
        100.0 * warning.contact_duty,
        warning.window,
        n_to_kn(warning.peak_force),
        100.0 * warning.confidence,
    )
}

fn capitalized(word: &str) -> String {
    let (first, rest) = word.split_at(word.len().min(1));
    first.to_uppercase() + rest
}

/// What the state of the inputs means for the warning; none when they are fresh.
fn doubt(input_quality: u8) -> Option<&'static str> {
    match input_quality {
        WhirlWarning::INPUT_OK => None,
        WhirlWarning::INPUT_NOT_RECEIVED => Some(
            "No input has been received: the model runs at the configured start values, and the confidence is lower.",
        ),
        WhirlWarning::INPUT_SLOW => Some("An input is late, and the confidence is slightly lower."),
        WhirlWarning::INPUT_STALE => {
            Some("An input is stale: the model runs at held or safe values, and the confidence is lower.")
        }
        WhirlWarning::INPUT_REJECTED => Some(
            "The newest sample of an input was rejected: the model runs at the last good one, and the confidence is lower.",
        ),
        _ => Some("The state of the inputs is unknown."),
    }
}
