//! `--cases step-error`: the configured step against an eighth of it, with its speed.

use flexdrill_bench::cases::{BenchCase, hard};
use flexdrill_bench::table::Table;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_realtime::monotonic;
use flexdrill_verify::step_error::{Calm, Course, Figure, Profile, Record, Statistics, StepErrorFailure, refined};

/// The stable runs are shorter by this than the chaotic ones: after 5 s the run-up and a whole turn are over.
const CALM_SHORTER: f64 = 6.0;

/// Runs all cases of the first configuration, and the others as they are; gives the tables.
///
/// # Errors
/// When a tool cannot be built. A failed step is a line below the tables.
pub(crate) fn tables(configs: &[(String, Config)], rpm: f64, duration: f64) -> anyhow::Result<String> {
    let mut tables = Tables::new();
    for (index, (path, config)) in configs.iter().enumerate() {
        let cases = if index == 0 { hard(config) } else { &hard(config)[..1] };
        for case in cases {
            let name = if index == 0 {
                case.name.to_owned()
            } else {
                format!("`{path}`, {} kN", case.wob)
            };
            tables.take(&name, case, &(case.changes)(config)?, rpm, duration)?;
        }
    }
    let steps: Vec<String> = configs
        .iter()
        .map(|(path, config)| {
            format!(
                "`{path}`: step {} ms, {}",
                1e3 * config.solver.time_step,
                config.solver.scheme_in_words()
            )
        })
        .collect();
    Ok(format!(
        "{}; from rest, up to {rpm} r/min, against an eighth of the step.\n\n\
        Without bit torque (stable), {} s, largest differences. Forces are averaged over 20 ms.\n\n{}\n\
        With all loads (chaotic), {duration} s, statistics over the last three quarters: three runs with the step and three with an eighth of it; in two of \
        each three the weight is changed by 1 N for the first 20 ms. *Overlap*: the ranges of the two threes do, as they would 9 times of 10 if the step \
        changed nothing.\n\n{}\n\
        Profiles of the RMS contact force, their distances over all stations: between two runs of the step, between two of the finer one, between one and \
        the other; what of the latter their scatter does not explain; size of the forces against the finer runs; stations whose ranges overlap (90 % are \
        expected if the step changes nothing).\n\n{}{}",
        steps.join("; "),
        duration / CALM_SHORTER,
        tables.calm.text(),
        tables.chaotic.text(),
        tables.profiles.text(),
        tables.failures
    ))
}

struct Tables {
    calm: Table,
    chaotic: Table,
    profiles: Table,
    failures: String,
}

impl Tables {
    fn new() -> Self {
        Self {
            calm: Table::new([
                "case",
                "bit speed, of its range",
                "joint positions, worst coordinate, of its range",
                "pipe-guide force, of its range over the layer",
                "guide-wall force",
            ]),
            chaotic: Table::new([
                "case",
                "real-time factor of processor time",
                "iterations per s",
                "ripple of the bit speed (rad/s); finer",
                "mean whirl ratio; finer",
                "energy error (%); finer",
            ]),
            profiles: Table::new([
                "case",
                "layer",
                "runs",
                "finer",
                "between",
                "unexplained",
                "size",
                "stations",
            ]),
            failures: String::new(),
        }
    }

    fn take(&mut self, name: &str, case: &BenchCase, config: &Config, rpm: f64, duration: f64) -> anyhow::Result<()> {
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: kn_to_n(case.wob),
            ..Inputs::default()
        };
        let calm = Course::of(config, inputs, duration / CALM_SHORTER);
        if let Some(row) = self.kept(name, calm_row(name, config, &calm))? {
            self.calm.row(row);
        }
        let chaotic = Course::of(config, inputs, duration);
        if let Some((row, profiles)) = self.kept(name, chaotic_rows(name, config, &chaotic))? {
            self.chaotic.row(row);
            profiles.into_iter().for_each(|row| self.profiles.row(row));
        }
        Ok(())
    }

    /// A failed step becomes a line.
    fn kept<T>(&mut self, name: &str, result: Result<T, StepErrorFailure>) -> anyhow::Result<Option<T>> {
        match result {
            Ok(value) => Ok(Some(value)),
            Err(failure @ StepErrorFailure::Step { .. }) => {
                self.failures.push_str(&format!("\nFailed: {name}: {failure}.\n"));
                Ok(None)
            }
            Err(other) => Err(other.into()),
        }
    }
}

fn calm_row(name: &str, config: &Config, motion: &Course) -> Result<[String; 5], StepErrorFailure> {
    eprintln!("{name}: two runs of {} s without bit torque", motion.duration);
    let config = config.with_value("tool.bit.friction_factor", 0.0)?;
    let coarse = Record::run(&config, motion, 0.0)?;
    let fine = Record::run(&refined(&config)?, motion, 0.0)?;
    let calm = Calm::of(&coarse, &fine);
    let force = |layer: usize| {
        format!(
            "{:.2} % of {:.0} N",
            100.0 * calm.forces[layer],
            calm.force_ranges[layer]
        )
    };
    Ok([
        name.to_owned(),
        format!("{:.3} %", 100.0 * calm.bit_speed),
        format!(
            "{:.2} % of {:.3} mm, joint {}",
            100.0 * calm.positions,
            1e3 * calm.position_range,
            calm.worst_joint
        ),
        force(0),
        force(1),
    ])
}

type ChaoticRows = ([String; 6], Vec<[String; 8]>);

fn chaotic_rows(name: &str, config: &Config, motion: &Course) -> Result<ChaoticRows, StepErrorFailure> {
    eprintln!(
        "{name}: three runs of {} s and three of an eighth of the step",
        motion.duration
    );
    let began = monotonic::processor_time();
    let runs = Record::runs(config, motion)?;
    let processor = (monotonic::processor_time() - began) as f64 * 1e-9;
    let fine = Record::runs(&refined(config)?, motion)?;
    let statistics = Statistics::of(&runs, &fine);
    let energy = |records: &[Record]| {
        let ratios = records.iter().map(|record| 100.0 * record.energy_error_ratio());
        ratios.map(|ratio| format!("{ratio:.3}")).collect::<Vec<_>>().join(", ")
    };
    let iterations = runs.iter().map(|run| run.iterations).sum::<f64>() / runs.len() as f64;
    let row = [
        name.to_owned(),
        format!("{:.2}", runs.len() as f64 * motion.duration / processor),
        format!("{iterations:.0}"),
        figure(&statistics.ripple),
        figure(&statistics.whirl_ratio),
        format!("{}; {}", energy(&runs), energy(&fine)),
    ];
    eprintln!("{}", row.join(" | "));
    let [inner, outer] = statistics.layers;
    let layers = [("both", statistics.whole), ("pipe-guide", inner), ("guide-wall", outer)];
    let profiles: Vec<_> = layers
        .iter()
        .map(|(layer, profile)| profile_row(name, layer, profile))
        .collect();
    for row in &profiles {
        eprintln!("{}", row.join(" | "));
    }
    Ok((row, profiles))
}

fn figure(figure: &Figure) -> String {
    let list = |values: &[f64]| values.iter().map(|x| format!("{x:.3}")).collect::<Vec<_>>().join(", ");
    let word = if figure.overlaps() { "overlap" } else { "apart" };
    format!(
        "{}; {}: {word}, {:+.1} %",
        list(&figure.runs),
        list(&figure.fine),
        100.0 * figure.excess()
    )
}

fn profile_row(name: &str, layer: &str, profile: &Profile) -> [String; 8] {
    let range = |[low, high]: [f64; 2]| format!("{:.2} to {:.2} %", 100.0 * low, 100.0 * high);
    [
        name.to_owned(),
        layer.to_owned(),
        range(profile.runs),
        range(profile.fine),
        range(profile.between),
        format!("{:.2} %", 100.0 * profile.systematic),
        format!("{:+.2} %", 100.0 * profile.excess),
        format!("{:.0} %", 100.0 * profile.overlapping),
    ]
}
