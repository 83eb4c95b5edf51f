//! Whether a map that was read makes sense.

use super::{Axis, Cell, MOST_CELLS, MOST_VALUES, Map, MapError, OfStart, Origin, SURE, Sample, Start, Verdict};

/// Longest text of a map (bytes).
const MOST_TEXT: usize = 4096;
/// Most alarms and priorities, and most figures, of a cell.
const MOST_ENTRIES: usize = 256;
/// Most members of a cell.
const MOST_MEMBERS: u32 = 10_000;

/// A value that is wrong, before the file is known.
struct Wrong {
    what: String,
    value: String,
    bound: String,
}

type Checked = Result<(), Wrong>;

fn ensure(holds: bool, what: impl Into<String>, value: impl ToString, bound: impl Into<String>) -> Checked {
    if holds {
        Ok(())
    } else {
        Err(Wrong {
            what: what.into(),
            value: value.to_string(),
            bound: bound.into(),
        })
    }
}

impl Map {
    /// # Errors
    /// With the first value that is out of its bounds or contradicts another.
    pub(super) fn check(&self, file: &str) -> Result<(), MapError> {
        self.whole().map_err(|Wrong { what, value, bound }| MapError::Damaged {
            file: file.to_owned(),
            what,
            value,
            bound,
        })
    }

    fn whole(&self) -> Checked {
        // A map is read from a file that may come from anywhere; texts are bounded before they are shown.
        for (what, text) in [("program", &self.program), ("title", &self.title)] {
            short(what, text)?;
        }
        for (what, hash) in [("configuration", &self.configuration), ("motion", &self.motion)] {
            let is_hash = hash.len() == 64 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
            ensure(is_hash, what, hash.escape_debug(), "64 hexadecimal digits")?;
        }
        // A limit of one would call every cell clear.
        ensure((0.0..1.0).contains(&self.limit), "limit", self.limit, "0 to below 1")?;
        axis("x", &self.x)?;
        axis("y", &self.y)?;
        ensure(self.x.key != self.y.key, "y.key", &self.y.key, "another than x.key")?;
        ensure(
            self.horizon > 0.0 && self.horizon.is_finite(),
            "horizon",
            self.horizon,
            "above 0 s",
        )?;
        let members = (1..=MOST_MEMBERS).contains(&self.members);
        ensure(members, "members", self.members, format!("1 to {MOST_MEMBERS}"))?;
        let starts = &self.starts;
        let are_starts = !starts.is_empty() && starts.is_sorted_by(|a, b| a < b);
        ensure(
            are_starts,
            "starts",
            format!("{starts:?}"),
            "`rest`, `running` or both, each once",
        )?;
        let timed = self.model_time >= 0.0 && self.model_time.is_finite();
        ensure(timed, "model_time", self.model_time, "0 s or more")?;
        if let Some(sample) = &self.posterior {
            ensure(
                self.plausible,
                "posterior",
                &sample.sha256,
                "left out where members are no plausible tools",
            )?;
            sample.check()?;
        }
        // The number of cells is bounded before they are compared: the product of two axes may be large.
        let expected = self.x.values.len() * self.y.values.len();
        ensure(
            expected <= MOST_CELLS,
            "cells",
            expected,
            format!("at most {MOST_CELLS}"),
        )?;
        ensure(
            self.cells.len() == expected,
            "cells",
            self.cells.len(),
            format!("{expected}, as the axes have"),
        )?;
        let rows = self
            .y
            .values
            .iter()
            .flat_map(|y| self.x.values.iter().map(move |x| (*x, *y)));
        let mut runs = 0;
        // Every cell says where it is. A file with rows in another order would otherwise be read as another map.
        for ((number, cell), at) in self.cells.iter().enumerate().zip(rows) {
            let place = format!("cells.{number}");
            let found = (cell.x, cell.y);
            ensure(
                found == at,
                &place,
                format!("{found:?}"),
                format!("at {at:?}, as the axes say"),
            )?;
            runs += self.cell_is_whole(&place, cell)?;
        }
        // The total is compared with its parts: in a file that was changed by hand they differ.
        ensure(
            self.runs == runs,
            "runs",
            self.runs,
            format!("{runs}, as the cells say"),
        )?;
        ensure(
            self.first_looks <= runs,
            "first_looks",
            self.first_looks,
            format!("at most {runs}, the runs"),
        )
    }

    /// Returns the runs of the cell.
    fn cell_is_whole(&self, place: &str, cell: &Cell) -> Result<u32, Wrong> {
        let count = self.starts.len();
        let what = format!("{place}.starts");
        ensure(
            cell.starts.len() == count,
            what,
            cell.starts.len(),
            format!("{count}, as `starts` has"),
        )?;
        let mut runs = 0;
        for (of, start) in cell.starts.iter().zip(&self.starts) {
            let place = format!("{place}.{}", Start::name(*start));
            of.check(&place, self)?;
            runs += u32::from(of.state.was_run());
        }
        let said = Verdict::of(&cell.starts);
        let what = format!("{place}.verdict");
        ensure(
            cell.verdict == said,
            what,
            cell.verdict.name(),
            format!("{}, as its starts say", said.name()),
        )?;
        Ok(runs)
    }
}

impl Sample {
    fn check(&self) -> Checked {
        for (what, hash) in [("sha256", &self.sha256), ("log_sha256", &self.log_sha256)] {
            let is_hash = hash.len() == 64 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
            let what = format!("posterior.{what}");
            ensure(is_hash, what, hash.escape_debug(), "64 hexadecimal digits")?;
        }
        short("posterior.version", &self.version)?;
        short("posterior.log", &self.log)?;
        let (count, what) = (self.keys.len(), "posterior.keys");
        ensure(count <= MOST_ENTRIES, what, count, format!("at most {MOST_ENTRIES}"))?;
        for key in &self.keys {
            short(what, key)?;
        }
        let effective = (0.0..=f64::from(self.members)).contains(&self.effective);
        let (what, bound) = ("posterior.effective", format!("0 to {}, its members", self.members));
        ensure(effective, what, self.effective, bound)
    }
}

impl OfStart {
    fn check(&self, place: &str, map: &Map) -> Checked {
        let members = map.members;
        let at = |what: &str| format!("{place}.{what}");
        short(&at("alarm"), &self.alarm)?;
        short(&at("failure"), &self.failure)?;
        interval(&at("interval"), self.interval)?;
        // Without a chance zero stands in for the bounds; whether one must be given is checked next.
        let chance = self.chance.unwrap_or(0.0);
        ensure((0.0..=1.0).contains(&chance), at("chance"), chance, "0 to 1")?;
        let known = self.state == Origin::Known;
        ensure(
            self.chance.is_some() == known,
            at("chance"),
            chance,
            "given exactly where the state is known",
        )?;
        // The verdict follows from chance and limit. A file in which they
        // differ was changed by hand or made by a faulty program.
        let said = chance > map.limit;
        let judged = match self.state {
            Origin::Known => self.expected == said,
            Origin::Unknown | Origin::NotKnown => !self.expected,
            Origin::Inferred => true,
        };
        ensure(
            judged,
            at("expected"),
            self.expected,
            "what the chance and `limit` say, false where unknown or not known",
        )?;
        // An inferred state needs the certainty by which it was inferred.
        let least = if self.state == Origin::Inferred { SURE } else { 0.0 };
        let confident = (least..=1.0).contains(&self.confidence);
        ensure(
            confident,
            at("confidence"),
            self.confidence,
            format!("{least} to 1, as the state is {}", self.state.name()),
        )?;
        ensure(
            self.members <= members,
            at("members"),
            self.members,
            format!("at most {members}"),
        )?;
        ensure(
            self.failed <= self.members,
            at("failed"),
            self.failed,
            format!("at most {}", self.members),
        )?;
        // Only states of runs may have members; inferred ones have none.
        let ran = self.members > 0;
        ensure(
            self.state.was_run() || !ran,
            at("members"),
            self.members,
            "0 where no run was made",
        )?;
        let ended = self.members - self.failed;
        ensure(
            known == (ended > 0),
            at("state"),
            self.state.name(),
            "known exactly where a member ended",
        )?;
        // Bounded before the loops, so that a large file costs no time.
        let entries = self.alarms.len().max(self.figures.len());
        ensure(
            entries <= MOST_ENTRIES,
            at("alarms"),
            entries,
            format!("at most {MOST_ENTRIES}"),
        )?;
        for (number, alarm) in self.alarms.iter().enumerate() {
            let place = at(&format!("alarms.{number}"));
            short(&format!("{place}.alarm"), &alarm.alarm)?;
            ensure(
                alarm.of == ended,
                format!("{place}.of"),
                alarm.of,
                format!("{ended}, the members that ended"),
            )?;
            let seen = (1..=ended).contains(&alarm.seen);
            ensure(seen, format!("{place}.seen"), alarm.seen, format!("1 to {ended}"))?;
            interval(&format!("{place}.interval"), alarm.interval)?;
            let first = alarm.first.unwrap_or(0.0);
            ensure(
                first >= 0.0 && first.is_finite(),
                format!("{place}.first"),
                first,
                "0 s or more",
            )?;
        }
        // Figures are checked for form only: their names belong to the program that made the map.
        for (number, figure) in self.figures.iter().enumerate() {
            let place = at(&format!("figures.{number}"));
            short(&format!("{place}.name"), &figure.name)?;
            short(&format!("{place}.unit"), &figure.unit)?;
            if let Some(quantiles) = figure.quantiles {
                let rising = quantiles.is_sorted() && quantiles.iter().all(|value| value.is_finite());
                ensure(
                    rising,
                    format!("{place}.quantiles"),
                    format!("{quantiles:?}"),
                    "finite and rising",
                )?;
            }
        }
        Ok(())
    }
}

fn axis(place: &str, axis: &Axis) -> Checked {
    for (what, text) in [("key", &axis.key), ("name", &axis.name), ("unit", &axis.unit)] {
        short(&format!("{place}.{what}"), text)?;
    }
    let what = format!("{place}.values");
    let count = axis.values.len();
    ensure(
        (2..=MOST_VALUES).contains(&count),
        &what,
        format!("{count} values"),
        format!("2 to {MOST_VALUES}"),
    )?;
    let rising = axis.values.is_sorted_by(|a, b| a < b) && axis.values.iter().all(|value| value.is_finite());
    ensure(rising, what, format!("{:?}", axis.values), "finite and rising")
}

fn interval(what: &str, [low, high]: [f64; 2]) -> Checked {
    let holds = low >= 0.0 && low <= high && high <= 1.0;
    ensure(holds, what, format!("{low} to {high}"), "an interval within 0 and 1")
}

fn short(what: &str, text: &str) -> Checked {
    ensure(
        text.len() <= MOST_TEXT,
        what,
        format!("{} bytes", text.len()),
        format!("at most {MOST_TEXT} bytes"),
    )
}
