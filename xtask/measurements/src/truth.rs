//! `--cases truth` and `--cases rig-truth`: statistics of chaotic motion by step, each over several runs, with their
//! scatter.

use std::path::PathBuf;

use flexdrill_bench::cases::{BenchCase, hard};
use flexdrill_bench::parallel::in_order;
use flexdrill_bench::table::Table;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::units::{kn_to_n, n_to_kn, rpm_to_rad_per_s};
use flexdrill_motion::{BIT, KICK_OFF};
use flexdrill_verify::step_error::{Course, Record};

use crate::parts::{Parts, Run};

/// Steps over the configuration's, the finest first: the others are held against it.
pub(crate) const STEPS: &[f64] = &[0.125, 0.25, 0.5, 1.0];

/// Those of the rig's tool: what `auto` takes at the start, the whole step, and the truth.
pub(crate) const RIG_STEPS: &[f64] = &[0.125, 0.5, 1.0];

/// A figure of a run.
struct Column {
    head: &'static str,
    decimals: usize,
    of: fn(&Record) -> f64,
    /// Whether a finer step has the same figure: what the step itself errs is none.
    compares: bool,
}

const fn column(head: &'static str, decimals: usize, of: fn(&Record) -> f64) -> Column {
    Column {
        head,
        decimals,
        of,
        compares: true,
    }
}

/// Of every tool.
const OF_MOTION: &[Column] = &[
    column("ripple of the bit speed (rad/s)", 3, Record::ripple),
    column("pipe-guide force (N)", 1, |record| record.force(0)),
    column("guide-wall force (N)", 1, |record| record.force(1)),
    column("whirl ratio", 3, |record| record.whirl_ratio),
];

/// Of a tool below a string.
const OF_TRANSFER: &[Column] = &[
    column("torque at the kick-off (N m)", 2, |record| record.torque[KICK_OFF]),
    column("torque at the bit (N m)", 2, |record| record.torque[BIT]),
    column("weight at the kick-off (kN)", 3, |record| {
        n_to_kn(record.weight[KICK_OFF])
    }),
    column("weight at the bit (kN)", 3, |record| n_to_kn(record.weight[BIT])),
];

const SHARE: Column = Column {
    head: "energy error share",
    decimals: 2,
    of: share,
    compares: false,
};

/// Mean energy error share of what was judged.
fn share(record: &Record) -> f64 {
    let judged = record.qualities.iter().filter(|quality| quality.judged);
    let (sum, count) = judged.fold((0.0, 0_u32), |(sum, count), quality| {
        (sum + quality.energy_error_share, count + 1)
    });
    sum / f64::from(count.max(1))
}

/// Mean of several runs and its standard error.
#[derive(Clone, Copy)]
struct Mean {
    value: f64,
    error: f64,
}

impl Mean {
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let value = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - value).powi(2)).sum();
        Self {
            value,
            // One run shows no scatter.
            error: (squares / (n - 1.0).max(1.0) / n).sqrt(),
        }
    }

    /// With its error, and how far it is from `fine` with the error of that.
    fn text(self, fine: Option<Self>, decimals: usize) -> String {
        let Self { value, error } = self;
        let own = format!("{value:.decimals$} ± {error:.decimals$}");
        let Some(fine) = fine else { return own };
        let ratio = value / fine.value;
        let relative = (error / value).hypot(fine.error / fine.value);
        format!(
            "{own} ({:+.1} ± {:.1} %)",
            100.0 * (ratio - 1.0),
            100.0 * ratio * relative
        )
    }
}

/// What is run.
#[derive(Debug)]
pub(crate) struct Plan<'a> {
    /// The tool.
    pub config: &'a Config,
    /// Speed (r/min).
    pub rpm: f64,
    /// Model time of a run (s).
    pub duration: f64,
    /// Runs per row.
    pub runs: u32,
    /// Steps over the configuration's, the finest first.
    pub steps: &'static [f64],
    /// With torque and weight from kick-off to bit.
    pub with_transfer: bool,
    /// Only so many of the cases.
    pub first: usize,
    /// Threads; the table does not depend on them.
    pub jobs: usize,
    /// Folder of the runs that are done.
    pub parts: Option<PathBuf>,
}

/// A run that is to be done.
struct Task {
    config: Config,
    motion: Course,
    nudge: f64,
    run: Run,
}

/// Runs every case with every step several times; gives the table.
///
/// # Errors
/// When a tool cannot be built, a step fails, or a part cannot be written.
pub(crate) fn tables(plan: &Plan<'_>) -> anyhow::Result<String> {
    let mut columns: Vec<&Column> = OF_MOTION.iter().collect();
    // Transfer needs a string; other tools have no such columns.
    if plan.with_transfer {
        columns.extend(OF_TRANSFER);
    }
    columns.push(&SHARE);
    // Few cases are for a first look, since all take hours.
    let cases = &hard(plan.config)[..plan.first.min(hard(plan.config).len())];
    let figures = run_all(&tasks(plan, cases)?, &columns, plan)?;
    let mut head = vec!["case", "step (ms)"];
    head.extend(columns.iter().map(|column| column.head));
    let mut table = Table::with_head(&head);
    // Tasks are in the order of cases, steps and runs, so that each row has its runs in one piece.
    let mut rows = figures.chunks(plan.runs as usize);
    for case in cases {
        let mut fine: Option<Vec<Mean>> = None;
        for part in plan.steps {
            let runs = rows.next().unwrap_or_default();
            let means: Vec<Mean> = (0..columns.len())
                .map(|k| Mean::of(&runs.iter().map(|run| run[k]).collect::<Vec<_>>()))
                .collect();
            let mut row = vec![
                case.name.to_owned(),
                format!("{}", 1e3 * part * plan.config.solver.time_step),
            ];
            // The first step of a case is the finest. All others have their difference to it.
            row.extend(columns.iter().enumerate().map(|(k, column)| {
                let fine = fine.as_ref().filter(|_| column.compares).map(|fine| fine[k]);
                means[k].text(fine, column.decimals)
            }));
            table.cells(&row);
            fine.get_or_insert(means);
        }
    }
    let transfer = if plan.with_transfer {
        " Torque and weight: means over sliding windows of `transfer.window`."
    } else {
        ""
    };
    Ok(format!(
        "{} runs of {} s from rest up to {} r/min per row, which differ by 1 N of weight in the first 20 ms; statistics over the last three \
        quarters: mean and standard error, in brackets the difference to the case's first row. Forces: root sum square over the layer's stations of their \
        RMS.{transfer} `solver.step: auto` takes half of the configuration's step, a quarter where the energy error share of half is 0.30 or more.\n\n{}",
        plan.runs,
        plan.duration,
        plan.rpm,
        table.text()
    ))
}

/// All runs in the order of the table.
fn tasks(plan: &Plan<'_>, cases: &[BenchCase]) -> anyhow::Result<Vec<Task>> {
    let mut tasks = Vec::new();
    for (number, case) in cases.iter().enumerate() {
        let tool = (case.changes)(plan.config)?;
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(plan.rpm),
            weight_on_bit: kn_to_n(case.wob),
            ..Inputs::default()
        };
        // Intervals are those of the whole step.
        let motion = Course::of(&tool, inputs, plan.duration);
        for (index, part) in plan.steps.iter().enumerate() {
            let config = tool.with_value("solver.time_step", part * tool.solver.time_step)?;
            for run in 0..plan.runs {
                let nudge = f64::from(run);
                tasks.push(Task {
                    config: config.clone(),
                    motion,
                    nudge,
                    run: Run {
                        name: format!("{number}_{index}_{run}"),
                        config: config.hash(),
                        motion: format!("{motion:?}, {nudge} N"),
                    },
                });
            }
        }
    }
    Ok(tasks)
}

/// The figures of every task, from the folder where they are there.
fn run_all(tasks: &[Task], columns: &[&Column], plan: &Plan<'_>) -> anyhow::Result<Vec<Vec<f64>>> {
    let parts = plan.parts.as_deref().map(Parts::open).transpose()?;
    in_order(tasks, plan.jobs, |task| {
        if let Some(figures) = parts.as_ref().and_then(|parts| parts.read(&task.run)) {
            return Ok(figures);
        }
        let record = Record::run(&task.config, &task.motion, task.nudge)?;
        let figures: Vec<f64> = columns.iter().map(|column| (column.of)(&record)).collect();
        eprintln!("{}: {figures:?}", task.run.name);
        if let Some(parts) = &parts {
            parts.write(&task.run, &figures)?;
        }
        Ok(figures)
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panicking")]
mod tests {
    use super::*;

    #[test]
    fn means_are_told_with_what_they_scatter_by() {
        let mean = Mean::of(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(mean.value, 2.5);
        // Sample deviation sqrt(5/3) over sqrt(4).
        assert!((mean.error - (5.0_f64 / 3.0).sqrt() / 2.0).abs() < 1e-12);
        let exact = Mean { value: 2.0, error: 0.0 };
        assert_eq!(mean.text(Some(exact), 1), "2.5 ± 0.6 (+25.0 ± 32.3 %)");
        assert_eq!(Mean::of(&[7.0]).text(None, 2), "7.00 ± 0.00");
    }

    /// The same rows by one thread and by two, and from the parts of an earlier run.
    #[test]
    fn rows_do_not_depend_on_threads_or_interruptions() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/small.yaml");
        let config = Config::load(file).unwrap();
        let folder = std::env::temp_dir().join(format!("flexdrill_truth_{}", std::process::id()));
        let table = |jobs: usize, parts: Option<PathBuf>| {
            tables(&Plan {
                config: &config,
                rpm: 40.0,
                duration: 0.1,
                runs: 2,
                steps: &[0.5, 1.0],
                with_transfer: true,
                first: 1,
                jobs,
                parts,
            })
            .unwrap()
        };
        let one = table(1, None);
        assert_eq!(
            one.lines().filter(|line| line.starts_with("| as it is")).count(),
            2,
            "{one}"
        );
        assert_eq!(table(2, Some(folder.clone())), one);
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 4);
        std::fs::remove_file(folder.join("0_1_1.json")).unwrap();
        assert_eq!(table(1, Some(folder.clone())), one);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
