//! What a run showed of the tool, after its first quarter.

use super::table::Table;
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::{rad_per_s_to_rpm, rad_to_deg};

/// Kept over a run; nothing grows with its length.
pub struct Figures {
    bit: Spread,
    bend: f64,
    at_limit: usize,
    inner_square: Vec<f64>,
    outer_square: Vec<f64>,
    inner_peak: Vec<f64>,
    outer_peak: Vec<f64>,
    /// Touching gaps of both layers, over all frames.
    touching: [usize; 2],
    taken: u32,
}

/// Mean, deviation and range of values.
#[derive(Default)]
struct Spread {
    sum: f64,
    squares: f64,
    range: Option<(f64, f64)>,
}

impl Spread {
    fn take(&mut self, x: f64) {
        self.sum += x;
        self.squares += x * x;
        let (low, high) = self.range.unwrap_or((x, x));
        self.range = Some((low.min(x), high.max(x)));
    }
}

impl Figures {
    /// Nothing yet, for a tool with snapshots of this size.
    pub fn new(snapshot: &Snapshot) -> Self {
        let stations = vec![0.0; snapshot.contacts.state.len()];
        Self {
            bit: Spread::default(),
            bend: 0.0,
            at_limit: 0,
            inner_square: stations.clone(),
            outer_square: stations.clone(),
            inner_peak: stations.clone(),
            outer_peak: stations,
            touching: [0; 2],
            taken: 0,
        }
    }

    /// Adds a frame.
    pub fn add(&mut self, snapshot: &Snapshot) {
        self.taken += 1;
        self.bit.take(rad_per_s_to_rpm(snapshot.bit.rotary_speed));
        let joints = &snapshot.joints;
        self.bend = joints.bend_angle.iter().fold(self.bend, |m, &b| m.max(b));
        self.at_limit += joints.stop_moment.iter().filter(|&&moment| moment > 0.0).count();
        let contacts = &snapshot.contacts;
        for state in &contacts.state {
            self.touching[0] += usize::from(state & 1);
            self.touching[1] += usize::from(state >> 1);
        }
        for (layer, square, peak) in [
            (&contacts.pipe_guide, &mut self.inner_square, &mut self.inner_peak),
            (&contacts.guide_wall, &mut self.outer_square, &mut self.outer_peak),
        ] {
            for s in 0..square.len() {
                square[s] += layer.normal_rms[s].powi(2);
                peak[s] = peak[s].max(layer.normal_peak[s]);
            }
        }
    }

    /// Touching gaps on average: pipe-guide, guide-wall.
    pub fn touching(&self) -> [f64; 2] {
        self.touching.map(|sum| sum as f64 / f64::from(self.taken.max(1)))
    }

    /// Adds a row per figure to `table`.
    pub fn rows(&self, last: &Snapshot, table: &mut Table) {
        // At least one, so that a run that was too short has zeros and not NaN.
        let count = f64::from(self.taken.max(1));
        let mean = self.bit.sum / count;
        // Rounding can make the variance of a steady speed slightly negative.
        let spread = (self.bit.squares / count - mean * mean).max(0.0).sqrt();
        let (low, high) = self.bit.range.unwrap_or_default();
        table.row([
            "bit speed: mean, rms ripple, range".into(),
            format!("{mean:.2}, {spread:.2}, {low:.1} to {high:.1} r/min"),
        ]);
        table.row([
            "bit torque at the end, stick-slip index".into(),
            format!("{:.1} N m, {:.3}", last.bit.torque, last.bit.stick_slip_index),
        ]);
        table.row([
            "largest bend, joints at limit on average".into(),
            format!("{:.3} deg, {:.1}", rad_to_deg(self.bend), self.at_limit as f64 / count),
        ]);
        for (name, square, peak) in [
            ("pipe-guide", &self.inner_square, &self.inner_peak),
            ("guide-wall", &self.outer_square, &self.outer_peak),
        ] {
            // Index of the largest value; the place of the largest RMS and that of the largest peak differ as a rule.
            let at = |values: &[f64]| {
                (0..values.len())
                    .max_by(|&a, &b| values[a].total_cmp(&values[b]))
                    .unwrap_or(0)
            };
            let (s, p) = (at(square), at(peak));
            let place = |s: usize| rad_to_deg(last.contacts.inclination[s]);
            table.row([
                format!("{name} force: largest rms, largest peak"),
                format!(
                    "{:.0} N at {:.0} deg, {:.0} N at {:.0} deg",
                    // The sums are of squares over the frames: the RMS is formed once, here.
                    (square[s] / count).sqrt(),
                    place(s),
                    peak[p],
                    place(p)
                ),
            ]);
        }
        // Counts at one instant: whirl comes and ends during a run, so these are of its last state.
        let kinds = |kind| last.whirl.kind.iter().filter(|&&k| k == kind).count();
        use flexdrill_motion::WhirlKind::{Backward, Chaotic, Forward};
        table.row([
            "whirl at the end: forward, backward, chaotic of all places".into(),
            format!(
                "{}, {}, {} of {}",
                kinds(Forward),
                kinds(Backward),
                kinds(Chaotic),
                last.whirl.kind.len()
            ),
        ]);
    }
}
