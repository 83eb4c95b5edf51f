//! Forecasts that are held against what came.

use std::collections::VecDeque;

use super::forecast::{Calibration, Forecast, HORIZON, Least, Widening};
use super::set_point::{LAG, SetPoint};
use super::trace::Trace;
use crate::rig_inputs::Fluctuation;
use flexdrill_config::InputsConfig;
use flexdrill_core::twin::Snapshot;

/// Seconds that are kept until the forecasts that begin in them arrive: a forecast that takes longer than its horizon is of
/// no use.
const KEPT: usize = 2 * HORIZON as usize;

/// A forecast that is held against what comes.
#[derive(Debug)]
struct Open {
    forecast: Forecast,
    /// Speed (rad/s) and weight (N) that it assumes.
    targets: [f64; 2],
    /// How its bands were published.
    widening: Widening,
    /// Second that is compared next.
    next: u64,
}

/// Least and most of what was set of speed (rad/s) and weight (N) in a second.
#[derive(Debug, Clone, Copy)]
struct Acted {
    number: u64,
    range: [[f64; 2]; 2],
}

/// What came, and the forecasts that it is compared with.
#[derive(Debug)]
pub struct Held {
    /// By how much speed and weight may change.
    same: Fluctuation,
    set_point: SetPoint,
    trace: Trace,
    acted: VecDeque<Acted>,
    step: u64,
    open: Vec<Open>,
    calibration: Calibration,
}

impl Held {
    /// Nothing yet, for a rig with these inputs.
    pub fn new(inputs: &InputsConfig) -> Self {
        Self {
            same: Fluctuation::of(inputs),
            set_point: SetPoint::new(inputs),
            trace: Trace::default(),
            acted: VecDeque::new(),
            step: 0,
            open: Vec::new(),
            calibration: Calibration::default(),
        }
    }

    /// Takes the peaks of an interval that ends at `time` (s of the run).
    pub fn peaks(&mut self, time: f64, snapshot: &Snapshot) {
        self.follow_reset(snapshot);
        self.trace.peaks(time, snapshot);
    }

    /// Looks at the run at `time` (s of the run), ten times a second, and compares the seconds that are complete.
    pub fn look(&mut self, time: f64, snapshot: &Snapshot) {
        self.follow_reset(snapshot);
        self.trace.look(time, snapshot);
        // Members waver as the rig does, so that single samples end no forecast; what is set is known a little later.
        self.set_point.take(time, &snapshot.applied);
        if let Some(set) = self.set_point.inputs().filter(|_| time >= LAG) {
            self.act((time - LAG) as u64, [set.rotary_speed, set.weight_on_bit]);
        }
        self.trace.keep(KEPT);
        self.compare();
    }

    /// How bands of now are to be published, while plausible tools differ by `least`.
    pub fn widening(&self, least: Least) -> Widening {
        Widening {
            factors: self.calibration.widths(),
            least,
        }
    }

    /// Holds a forecast at speed (rad/s) and weight (N), published with this `widening`, against what comes and what came since
    /// its start.
    pub fn hold(&mut self, forecast: Forecast, targets: [f64; 2], widening: Widening) {
        self.open.push(Open {
            next: forecast.first,
            widening,
            targets,
            forecast,
        });
    }

    /// How forecasts and what came compare so far.
    pub fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// Whether speed (rad/s) and weight (N) are close enough to those of a forecast for it to speak of them.
    pub fn is_for(&self, targets: &[f64; 2], asked: [f64; 2]) -> bool {
        self.same.covers(*targets, asked)
    }

    /// Nothing that follows a reset of the model was forecast.
    fn follow_reset(&mut self, snapshot: &Snapshot) {
        if snapshot.step < self.step {
            (self.trace, self.acted) = (Trace::default(), VecDeque::new());
            self.open.clear();
        }
        self.step = snapshot.step;
    }

    fn act(&mut self, number: u64, values: [f64; 2]) {
        match self.acted.back_mut().filter(|last| last.number == number) {
            Some(last) => {
                for (range, value) in last.range.iter_mut().zip(values) {
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
            None => self.acted.push_back(Acted {
                number,
                range: values.map(|value| [value, value]),
            }),
        }
        if self.acted.len() > KEPT {
            self.acted.pop_front();
        }
    }

    /// Compares the seconds that are complete.
    fn compare(&mut self) {
        let complete = self.trace.seconds().back().map(|second| second.number);
        let known = self.acted.back().map(|acted| acted.number);
        let Some(newest) = complete.zip(known).map(|(complete, known)| complete.min(known)) else {
            return;
        };
        for open in &mut self.open {
            let end = open.forecast.first + HORIZON;
            while open.next < newest.min(end) {
                let number = open.next;
                open.next += 1;
                let acted = self.acted.iter().find(|acted| acted.number == number);
                if acted.is_some_and(|acted| !stayed(acted, &open.targets, &self.same)) {
                    // Something else acted: the rest of the forecast says nothing of it.
                    open.next = end;
                    break;
                }
                let (first, ahead) = (open.forecast.first, number - open.forecast.first);
                let bands = open.forecast.seconds.get(ahead as usize);
                let second = self.trace.seconds().iter().find(|second| second.number == number);
                if let (Some(bands), Some(second)) = (bands, second) {
                    self.calibration
                        .compare(first, ahead, bands, &open.widening, &second.values());
                }
            }
        }
        self.open.retain(|open| open.next < open.forecast.first + HORIZON);
    }
}

fn stayed(acted: &Acted, targets: &[f64; 2], same: &Fluctuation) -> bool {
    let [speed, weight] = acted.range;
    [0, 1]
        .map(|end| [speed[end], weight[end]])
        .iter()
        .all(|now| same.covers(*targets, *now))
}
