//! A table of lives in words.

use flexdrill_life::{JointOfFile, Lives, Part, UNKNOWN_TO_A_CLASS, Verdict, damage_in_words, damage_with_band};
use flexdrill_text::counted;

fn joint(rank: usize, joint: &JointOfFile) -> String {
    let other = match joint.part {
        Part::Stop => format!("link below {}", damage_with_band(joint.link)),
        Part::Link => format!("stop {}", damage_with_band(joint.stop)),
    };
    let place = joint.places.last().copied().unwrap_or_default();
    let left = match joint.hours_left {
        Some(0.0) | None => String::new(),
        Some(hours) => format!(" At its mean rate a crack is possible after {hours:.1} h more."),
    };
    format!(
        "{rank:>3}. {}: {} {}; {other}; {:.1} h in {}, last at place {place} from the bit. {}{left}",
        joint.serial,
        joint.part.words(),
        damage_with_band(joint.damage),
        joint.hours,
        counted(joint.runs as u64, "run"),
        joint.verdict.words()
    )
}

/// The lines: heading, joints, what is not known. Without `all` joints that need no inspection are counted.
pub(super) fn lines(lives: &Lives, all: bool) -> Vec<String> {
    let (kind, ranked) = (&lives.kind, lives.ranked());
    let mut lines = vec![format!(
        "{}: {} in {}; class {} in {}. Joints to inspect, the most damaged first; in brackets 90 % of the scatter:",
        lives.file,
        counted(ranked.len() as u64, "joint"),
        counted(lives.runs() as u64, "run"),
        kind.class,
        kind.environment.replace('_', " ")
    )];
    let due = ranked.iter().filter(|of| all || of.verdict > Verdict::Sound).count();
    lines.extend(
        ranked
            .iter()
            .take(due)
            .enumerate()
            .map(|(index, of)| joint(index + 1, of)),
    );
    match ranked.get(due) {
        Some(next) if due == 0 => lines.push(format!(
            "None: the most damaged is {} with {}. {}",
            next.serial,
            damage_with_band(next.damage),
            Verdict::Sound.words()
        )),
        Some(_) => lines.push(format!(
            "{} more below a damage of {} at 95 %: no inspection is due by fatigue.",
            counted((ranked.len() - due) as u64, "joint"),
            damage_in_words(1.0 / kind.design_factor)
        )),
        None => {}
    }
    lines.push(UNKNOWN_TO_A_CLASS.to_owned());
    lines
}
