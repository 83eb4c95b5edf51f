//! What a map says of its members, in words.

use super::{Map, OfStart, Origin};

impl Map {
    /// Fewest and most members that ended at a start that was run; nothing where none ended.
    pub fn members_ended(&self) -> Option<[u32; 2]> {
        let starts = self.cells.iter().flat_map(|cell| &cell.starts);
        let ended = starts
            .filter(|start| start.state == Origin::Known)
            .map(|start| start.members - start.failed);
        ended.fold(None, |range: Option<[u32; 2]>, of| {
            let [least, most] = range.unwrap_or([of, of]);
            Some([least.min(of), most.max(of)])
        })
    }

    /// Fewest members that ended at a start that is known to be clear by its runs, and the chance of an alarm that so many
    /// without a sighting exclude. Nothing where no start is. Starts with a first look alone are left out
    /// ([`Map::excluded_by_looks`]).
    pub fn excluded(&self) -> Option<(u32, f64)> {
        let least = self
            .clear_by_runs()
            .filter(|start| !self.is_first_look(start))
            .map(|start| start.members)
            .min()?;
        Some((least, excludes(least)))
    }

    /// Starts that are known to be clear by a first look alone, and the mean chance over them that so many looks without a
    /// sighting exclude. Nothing where no start is.
    pub fn excluded_by_looks(&self) -> Option<(u32, f64)> {
        let looks = self.clear_by_runs().filter(|start| self.is_first_look(start)).count() as u32;
        (looks > 0).then(|| (looks, excludes(looks)))
    }

    fn clear_by_runs(&self) -> impl Iterator<Item = &OfStart> {
        let starts = self.cells.iter().flat_map(|cell| &cell.starts);
        starts.filter(|start| start.state == Origin::Known && !start.expected && start.failed == 0)
    }

    /// Whether a start without an alarm has its first member alone. Where all members run, clear ones are two at least.
    const fn is_first_look(&self, start: &OfStart) -> bool {
        self.first_looks > 0 && start.members == 1
    }

    /// How many members ended per run, and what so many without an alarm exclude. The numbers are those that ran.
    pub fn members_in_words(&self) -> String {
        let Some([least, most]) = self.members_ended() else {
            return "No member of any run ended.".to_owned();
        };
        let ended = if least == most {
            format!("{least}")
        } else {
            format!("{least} to {most}")
        };
        // Fewer than asked for needs a reason, or the reader takes the number for a fault.
        let why = match self.run_all {
            _ if least == self.members => "",
            true => "; the others failed",
            false if self.first_alarm => "; a run ends early once its members decide whether an alarm comes",
            false => "; a run ends early once its members decide every alarm",
        };
        let members = match (self.plausible, self.members) {
            (true, 1) => "plausible tool",
            (true, _) => "plausible tools",
            (false, 1) => "member",
            (false, _) => "members",
        };
        let mut text = format!("In each run {ended} of at most {} {members} ended{why}.", self.members);
        // What no alarm excludes, so that "clear" is not taken for "never".
        if let Some((least, chance)) = self.excluded() {
            let cell = match self.first_looks {
                0 => "a clear cell",
                _ => "a clear cell next to others",
            };
            let excludes = format!(
                " No alarm in {least} excludes chances above {:.0} %: {cell} may have up to that.",
                100.0 * chance
            );
            text.push_str(&excludes);
        }
        if let Some((looks, chance)) = self.excluded_by_looks() {
            let excludes = format!(
                " {looks} clear runs that have clear neighbours only have one member each: no alarm in these {looks} excludes \
                 a mean chance above {:.0} % over them.",
                100.0 * chance
            );
            text.push_str(&excludes);
        }
        text
    }

    /// What the members are, and which tools "clear" does not speak of.
    pub fn tools_in_words(&self) -> String {
        let drawn = match &self.posterior {
            _ if !self.plausible => {
                return "All members are the tool of the configuration: clear is clear for its friction, its joints and its law \
                        of the bit."
                    .to_owned();
            }
            None => {
                "Plausible tools are drawn from uncertainty of the configuration, without a calibration.".to_owned()
            }
            Some(of) => format!(
                "Plausible tools are drawn from a calibration: {} members, {:.0} alike by their weights, fitted to rows {} to \
                 {} of {} by flexdrill {}, of {} (SHA-256 {:.12}). Other keys are drawn from uncertainty, given these.",
                of.members,
                of.effective,
                of.rows[0],
                of.rows[1],
                of.log.escape_debug(),
                of.version.escape_debug(),
                of.keys.join(", "),
                of.sha256
            ),
        };
        format!(
            "{drawn} They all have its kind of joints, law of the bit and sections of the string: clear does not speak of \
             others, and simulated rigs with others had alarms in clear cells (docs/safe_window.md)."
        )
    }
}

/// The chance that so many members without a sighting exclude: the upper end of the 95 % interval (Wilson).
fn excludes(members: u32) -> f64 {
    const Z: f64 = 1.959_963_984_540_054;
    Z * Z / (f64::from(members) + Z * Z)
}
