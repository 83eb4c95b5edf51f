//! `flexdrill bench`: a run at constant inputs as fast as it goes, with the figures that `docs/measurements.md` quotes.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use hdrhistogram::Histogram;

use crate::config::Config;
use crate::inputs::units::{kn_to_n, rad_per_s_to_rpm, rpm_to_rad_per_s};
use crate::mechanics::StepOutcome;
use crate::twin::{Inputs, Simulation, Snapshot};

/// Runs a configuration at constant inputs as fast as it goes and prints its speed and its figures, as Markdown.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Configurations to run, one after another.
    #[arg(long = "config", default_values = ["config/default.yaml", "config/coarse.yaml"])]
    configs: Vec<PathBuf>,
    /// Model time after the static start (s).
    #[arg(long, default_value_t = 20.0)]
    duration: f64,
    /// Rotary speed (r/min).
    #[arg(long, default_value_t = 40.0)]
    rpm: f64,
    /// Weight on bit (kN), on from the start.
    #[arg(long, default_value_t = 10.0)]
    wob: f64,
    /// Another model step than the configuration's (s).
    #[arg(long)]
    time_step: Option<f64>,
    /// Values to change, as KEY=NUMBER with the key's dotted path (may be given more than once).
    #[arg(long = "set", value_name = "KEY=NUMBER")]
    set: Vec<String>,
}

/// Model time in one published frame (s).
const FRAME: f64 = 0.02;

/// Runs the subcommand.
///
/// # Errors
/// When a configuration is refused or a step fails.
pub fn run(args: &BenchArgs) -> anyhow::Result<()> {
    for path in &args.configs {
        let mut config = Config::load(path)?.with_value("inputs.weight_on_bit.initial_kn", args.wob)?;
        if let Some(step) = args.time_step {
            config = config.with_value("solver.time_step", step)?;
        }
        for change in &args.set {
            let (key, value) = change
                .split_once('=')
                .ok_or_else(|| anyhow::anyhow!("--set {change}: expected KEY=NUMBER"))?;
            let value: f64 = value
                .parse()
                .map_err(|_| anyhow::anyhow!("--set {change}: {value:?} is not a number"))?;
            config = config.with_value(key, value)?;
        }
        println!(
            "\n### {}, {} r/min, {} kN, {} s\n",
            path.display(),
            args.rpm,
            args.wob,
            args.duration
        );
        println!("| figure | value |\n|---|---|");
        one(&config, args)?;
    }
    Ok(())
}

fn row(figure: &str, value: impl std::fmt::Display) {
    println!("| {figure} | {value} |");
}

fn one(config: &Config, args: &BenchArgs) -> anyhow::Result<()> {
    let started = Instant::now();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
    row("static start", format!("{:.3} s", started.elapsed().as_secs_f64()));
    let dt = simulation.settings().time_step;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(args.rpm),
        weight_on_bit: kn_to_n(args.wob),
    };
    let mut snapshot = simulation.new_snapshot();
    let mut figures = Figures::new(&snapshot);
    // Nanoseconds up to a minute, to three digits.
    let mut steps = Histogram::<u64>::new_with_bounds(1, 60_000_000_000, 3)?;
    let mut frames = steps.clone();
    let per_frame = (FRAME / dt).round().max(1.0) as u64;
    let total = (args.duration / dt).round() as u64;
    let (mut busy, mut frame) = (Duration::ZERO, Duration::ZERO);
    let mut most_iterations = 0;
    for step in 1..=total {
        let before = Instant::now();
        match simulation.advance(&inputs) {
            StepOutcome::Advanced { iterations, .. } => most_iterations = most_iterations.max(iterations),
            StepOutcome::Failed(failure) => anyhow::bail!("step {step} failed: {failure:?}"),
        }
        let mut took = before.elapsed();
        steps.saturating_record(u64::try_from(took.as_nanos())?);
        if step.is_multiple_of(per_frame) {
            let before = Instant::now();
            simulation.snapshot(&mut snapshot, true);
            took += before.elapsed();
            figures.take(&snapshot, step * 4 >= total);
        }
        busy += took;
        frame += took;
        if step.is_multiple_of(per_frame) {
            frames.saturating_record(u64::try_from(frame.as_nanos())?);
            frame = Duration::ZERO;
        }
    }
    let ms = |histogram: &Histogram<u64>, q: f64| histogram.value_at_quantile(q) as f64 * 1e-6;
    let counters = simulation.stepper().counters();
    row(
        "unknowns, step",
        format!("{}, {} ms", simulation.stepper().model().degrees_of_freedom(), 1e3 * dt),
    );
    row("real-time factor", format!("{:.2}", args.duration / busy.as_secs_f64()));
    row(
        "step: median, p99, p99.9, max",
        format!(
            "{:.3}, {:.3}, {:.3}, {:.3} ms",
            ms(&steps, 0.5),
            ms(&steps, 0.99),
            ms(&steps, 0.999),
            steps.max() as f64 * 1e-6
        ),
    );
    row(
        "frame of 20 ms: p99.9, max",
        format!("{:.2}, {:.2} ms", ms(&frames, 0.999), frames.max() as f64 * 1e-6),
    );
    row(
        "Newton iterations per step: mean, most",
        format!("{:.2}, {most_iterations}", counters.iterations as f64 / total as f64),
    );
    row(
        "halved, rejected, failed steps",
        format!(
            "{}, {}, {}",
            counters.halved_steps, counters.rejected, counters.failed_steps
        ),
    );
    figures.print(&snapshot);
    row("peak memory", peak_memory().unwrap_or_else(|| "unknown".to_owned()));
    Ok(())
}

/// What the run showed, after its first quarter.
struct Figures {
    bit: Vec<f64>,
    bend: f64,
    at_limit: Vec<usize>,
    inner_square: Vec<f64>,
    outer_square: Vec<f64>,
    inner_peak: Vec<f64>,
    outer_peak: Vec<f64>,
    taken: u32,
}

impl Figures {
    fn new(snapshot: &Snapshot) -> Self {
        let stations = vec![0.0; snapshot.contacts.state.len()];
        Self {
            bit: vec![],
            bend: 0.0,
            at_limit: vec![],
            inner_square: stations.clone(),
            outer_square: stations.clone(),
            inner_peak: stations.clone(),
            outer_peak: stations,
            taken: 0,
        }
    }

    fn take(&mut self, snapshot: &Snapshot, settled: bool) {
        if !settled {
            return;
        }
        self.taken += 1;
        self.bit.push(rad_per_s_to_rpm(snapshot.bit.rotary_speed));
        let joints = &snapshot.joints;
        self.bend = joints.bend_angle.iter().fold(self.bend, |m, &b| m.max(b));
        self.at_limit
            .push(joints.stop_moment.iter().filter(|&&moment| moment > 0.0).count());
        let contacts = &snapshot.contacts;
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

    fn print(&self, last: &Snapshot) {
        let count = self.bit.len().max(1) as f64;
        let mean = self.bit.iter().sum::<f64>() / count;
        let spread = (self.bit.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count).sqrt();
        let (low, high) = self
            .bit
            .iter()
            .fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
        row(
            "bit speed: mean, rms ripple, range",
            format!("{mean:.2}, {spread:.2}, {low:.1} to {high:.1} r/min"),
        );
        row(
            "bit torque at the end, stick-slip index",
            format!("{:.1} N m, {:.3}", last.bit.torque, last.bit.stick_slip_index),
        );
        let joints = self.at_limit.iter().sum::<usize>() as f64 / count;
        row(
            "largest bend, joints at limit on average",
            format!("{:.3} deg, {joints:.1}", self.bend.to_degrees()),
        );
        for (name, square, peak) in [
            ("pipe-guide", &self.inner_square, &self.inner_peak),
            ("guide-wall", &self.outer_square, &self.outer_peak),
        ] {
            let at = |values: &[f64]| {
                (0..values.len())
                    .max_by(|&a, &b| values[a].total_cmp(&values[b]))
                    .unwrap_or(0)
            };
            let (s, p) = (at(square), at(peak));
            let place = |s: usize| last.contacts.inclination[s].to_degrees();
            row(
                &format!("{name} force: largest rms, largest peak"),
                format!(
                    "{:.0} N at {:.0} deg, {:.0} N at {:.0} deg",
                    (square[s] / f64::from(self.taken.max(1))).sqrt(),
                    place(s),
                    peak[p],
                    place(p)
                ),
            );
        }
        let kinds = |kind| last.whirl.kind.iter().filter(|&&k| k == kind).count();
        use crate::analysis::WhirlKind::{Backward, Chaotic, Forward};
        row(
            "whirl at the end: forward, backward, chaotic of all places",
            format!(
                "{}, {}, {} of {}",
                kinds(Forward),
                kinds(Backward),
                kinds(Chaotic),
                last.whirl.kind.len()
            ),
        );
        let energy = &last.energy;
        row(
            "energy: drive, bit, friction, error",
            format!(
                "{:.0}, {:.0}, {:.0}, {:.2} J ({:.3} %)",
                energy.drive,
                energy.bit,
                energy.friction,
                energy.error,
                100.0 * energy.error.abs() / energy.drive.abs().max(f64::MIN_POSITIVE)
            ),
        );
    }
}

/// Largest resident set of this process so far, as the kernel counts it.
fn peak_memory() -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.trim_start_matches("VmHWM:").trim().to_owned())
}
