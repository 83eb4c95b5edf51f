//! `--cases truth`: statistics of chaotic motion by step, each over several runs, with their scatter.

use flexdrill_bench::cases::hard;
use flexdrill_bench::table::Table;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_verify::step_error::{Motion, Record};

/// Steps over the configuration's, the finest first: the others are held against it.
const STEPS: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

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
            // One run has no scatter to tell.
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

/// Figures of one case with one step: ripple, forces, whirl ratio, energy error share.
type Figures = [Mean; 5];

const DECIMALS: [usize; 5] = [3, 1, 1, 3, 2];

/// Runs every case with every step `runs` times; gives the table.
///
/// # Errors
/// When a tool cannot be built or a step fails.
pub(crate) fn tables(config: &Config, rpm: f64, duration: f64, runs: u32) -> anyhow::Result<String> {
    let mut table = Table::new([
        "case",
        "step (ms)",
        "ripple of the bit speed (rad/s)",
        "pipe-guide force (N)",
        "guide-wall force (N)",
        "whirl ratio",
        "energy error share",
    ]);
    for case in hard(config) {
        let tool = (case.changes)(config)?;
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: kn_to_n(case.wob),
            ..Inputs::default()
        };
        let whole = Motion::of(&tool, inputs, duration);
        let mut fine: Option<Figures> = None;
        for part in STEPS {
            let step = part * tool.solver.time_step;
            let config = tool.with_value("solver.time_step", step)?;
            let figures = figures(&config, &whole, runs)?;
            let cells = (0..5).map(|k| {
                // The share is what the step itself errs, not a figure that a finer one has too.
                let fine = fine.filter(|_| k < 4).map(|fine| fine[k]);
                figures[k].text(fine, DECIMALS[k])
            });
            let row: Vec<String> = [case.name.to_owned(), format!("{}", 1e3 * step)]
                .into_iter()
                .chain(cells)
                .collect();
            eprintln!("{}", row.join(" | "));
            table.cells(&row);
            fine.get_or_insert(figures);
        }
    }
    Ok(format!(
        "{runs} runs of {duration} s from rest up to {rpm} r/min per row, which differ by 1 N of weight in the first 20 ms; statistics over the last three \
        quarters: mean and standard error, in brackets the difference to the case's first row. Forces: root sum square over the layer's stations of their \
        RMS. `solver.step: auto` takes half of the configuration's step, a quarter where the energy error share of half is 0.30 or more.\n\n{}",
        table.text()
    ))
}

fn figures(config: &Config, motion: &Motion, runs: u32) -> anyhow::Result<Figures> {
    let mut values: [Vec<f64>; 5] = Default::default();
    for run in 0..runs {
        let record = Record::run(config, motion, f64::from(run))?;
        let judged: Vec<f64> = record
            .qualities
            .iter()
            .filter(|quality| quality.judged)
            .map(|quality| quality.energy_error_share)
            .collect();
        let share = judged.iter().sum::<f64>() / judged.len().max(1) as f64;
        let figures = [
            record.ripple(),
            record.force(0),
            record.force(1),
            record.whirl_ratio,
            share,
        ];
        for (values, figure) in values.iter_mut().zip(figures) {
            values.push(figure);
        }
    }
    Ok(values.map(|values| Mean::of(&values)))
}

#[cfg(test)]
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
}
