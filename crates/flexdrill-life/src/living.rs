//! What the joints of a run have lived while the run lasts: before it, by a table, and in it, by what it counts. `twin/ageing`
//! has it by serial number.

use flexdrill_base::Band;
use flexdrill_config::Config;
use flexdrill_messages::Ageing;

use super::{Counted, Kind, LifeError, Lives, RunLife};
use crate::run::damages;

/// The joints of a run with their lives so far. It is a function of the configuration, of what was lived before and of the
/// counts, so that a replay repeats it.
#[derive(Debug, Clone)]
pub struct LivingJoints {
    kind: Kind,
    /// Hash of the configuration.
    configuration: String,
    /// Serial numbers, from the top as in messages.
    serials: Vec<String>,
    /// The table that the run began with; none where a recording says what was lived before.
    table: Option<Lives>,
    /// Per joint from the top: median damages of its stop and of the link below it before this run.
    before: Vec<[f64; 2]>,
    /// Begin of the run (ns since 1970).
    start: i64,
    counted: Counted,
}

impl LivingJoints {
    /// The joints of a configuration with what a table has of them; without a table their lives begin with this run.
    ///
    /// # Errors
    /// When the configuration has no class or no serial numbers, or counts nothing, or the table has joints of another kind.
    pub fn of_table(config: &Config, table: Option<Lives>) -> Result<Self, LifeError> {
        let run = RunLife::begun(config, 0)?;
        if let Some(lives) = &table {
            lives.kind.is_of(&lives.file, &run.kind)?;
        }
        let serials: Vec<String> = run.joints.into_iter().rev().map(|joint| joint.serial).collect();
        Ok(Self {
            before: vec![[0.0; 2]; serials.len()],
            kind: run.kind,
            configuration: run.configuration,
            serials,
            table,
            start: 0,
            counted: Counted::default(),
        })
    }

    /// Those of a recorded run, from one of its messages; none where it began without a table.
    pub fn of_recording(config: &Config, message: &Ageing) -> Option<Self> {
        let serials = &message.joint_serial_number;
        let [stop, link] = [&message.stop_life_damage_before, &message.link_life_damage_before];
        if serials.is_empty() || [stop.len(), link.len()] != [serials.len(); 2] {
            return None;
        }
        Some(Self {
            kind: Kind::of(config).ok()?,
            configuration: config.hash(),
            serials: serials.clone(),
            table: None,
            before: stop.iter().zip(link).map(|(stop, link)| [*stop, *link]).collect(),
            start: 0,
            counted: Counted::default(),
        })
    }

    /// The run begins at an instant (ns since 1970): runs of the table that began earlier are those before it.
    pub fn begin(&mut self, start: i64) {
        self.start = start;
        let Some(lives) = &self.table else { return };
        let run = (start, self.configuration.as_str());
        let before = self.serials.iter().map(|serial| lives.damages_before(run, serial));
        self.before = before.collect();
    }

    /// Adds the lives to a message that has the counts of this run.
    pub fn complete(&mut self, message: &mut Ageing) {
        // A count of another tool or class adds nothing, as in the table.
        self.counted.push(message, self.start);
        let joints = self.before.len();
        // A run that begins has added nothing yet; counts of another class are no part of these lives.
        let run = match damages(&self.kind, &self.counted) {
            Ok(run) => run,
            Err(LifeError::NothingCounted) => vec![[0.0; 2]; joints],
            Err(_) => Vec::new(),
        };
        let known = run.len() == joints && message.stop_damage_rate.len() == joints;
        if known {
            message.joint_serial_number.clone_from(&self.serials);
        } else {
            message.joint_serial_number.clear();
        }
        let run = if known { run } else { Vec::new() };
        self.fill(
            0,
            &run,
            [
                &mut message.stop_life_damage,
                &mut message.stop_life_damage_low,
                &mut message.stop_life_damage_high,
                &mut message.stop_life_damage_before,
            ],
        );
        self.fill(
            1,
            &run,
            [
                &mut message.link_life_damage,
                &mut message.link_life_damage_low,
                &mut message.link_life_damage_high,
                &mut message.link_life_damage_before,
            ],
        );
    }

    /// Fills median, ends of the band and part before the run of the stops (0) or links (1), with the damages of the run; empty
    /// without them.
    fn fill(&self, of: usize, run: &[[f64; 2]], [median, low, high, before]: [&mut Vec<f64>; 4]) {
        for list in [&mut *median, &mut *low, &mut *high, &mut *before] {
            list.clear();
        }
        // The scatter is that of the joint, the same in all its runs: the band is that of the sum.
        let factor = self.kind.details[of].band();
        for (lived, counted) in self.before.iter().zip(run) {
            let band = Band::within_factor(lived[of] + counted[of], factor);
            median.push(band.median);
            low.push(band.low);
            high.push(band.high);
            before.push(lived[of]);
        }
    }
}
