//! `--cases scaling`: how the cost grows with the number of links.

use flexdrill_bench::measure::{Load, Measured, percentiles, run};
use flexdrill_bench::table::Table;
use flexdrill_config::Config;

/// Sizes of the tool: from a quarter of the paper's to four times it.
const LINKS: [usize; 5] = [8, 16, 33, 66, 132];
/// Runs of each, in turn: a machine's speed varies from minute to minute by more than what is measured. The fastest
/// counts.
const ROUNDS: u32 = 5;

/// Runs all sizes; gives the table and the fit.
///
/// # Errors
/// When a tool cannot be built or a step fails.
pub(crate) fn tables(config: &Config, load: Load, duration: f64) -> anyhow::Result<String> {
    let mut table = Table::new([
        "links",
        "unknowns",
        "real-time factor",
        "step: mean of processor time, p50, p99 (us)",
        "iterations per step",
        "us per link and step",
        "us per link and iteration",
        "touching gaps per link: pipe-guide, guide-wall",
    ]);
    let (mut steps, mut iterations) = (Vec::new(), Vec::new());
    let mut fastest: [Option<Measured>; LINKS.len()] = Default::default();
    // Rounds in turn, so that a slow minute of the machine hits all sizes.
    for round in 1..=ROUNDS {
        for (links, fastest) in LINKS.into_iter().zip(&mut fastest) {
            eprintln!("{links} links: {duration} s of model time, {round} of {ROUNDS}");
            let measured = run(&config.with_links(links)?, load, duration, |_| {})?;
            if let Some(failure) = measured.failure {
                anyhow::bail!("{links} links: a step failed: {failure}");
            }
            // The fastest run is the one that was least disturbed.
            if fastest
                .as_ref()
                .is_none_or(|before| measured.step_time() < before.step_time())
            {
                *fastest = Some(measured);
            }
        }
    }
    for (links, measured) in LINKS.into_iter().zip(fastest.iter().flatten()) {
        // Cost by link and by iteration apart: a larger tool also needs more iterations.
        let mean = measured.step_time();
        let [p50, p99, ..] = percentiles(&measured.step_times);
        let size = links as f64;
        table.row([
            links.to_string(),
            measured.unknowns.to_string(),
            format!("{:.2}", measured.real_time_factor()),
            format!("{mean:.1}, {:.1}, {:.1}", 1e3 * p50, 1e3 * p99),
            format!("{:.2}", measured.iterations()),
            format!("{:.2}", mean / size),
            format!("{:.2}", mean / size / measured.iterations()),
            measured
                .figures
                .touching()
                .map(|gaps| format!("{:.2}", gaps / size))
                .join(", "),
        ]);
        // The exponent is fitted to all sizes: the cache bends the curve between two of them.
        steps.push((size, mean));
        iterations.push((size, mean / measured.iterations()));
    }
    Ok(format!(
        "{duration} s of model time each, the fastest of {ROUNDS} runs in turn, {} r/min, {} kN; links of the same length, a shorter tool ends in the curve, a longer one goes on level behind it.\n\n{}\nFit of cost = a x links^b: b = {:.2} per step, {:.2} per iteration (1 is linear).\n",
        load.rpm,
        load.wob,
        table.text(),
        exponent(&steps),
        exponent(&iterations)
    ))
}

/// Least-squares slope of log y over log x.
fn exponent(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0.ln()), mean(|p| p.1.ln()));
    let (mut product, mut square) = (0.0, 0.0);
    for p in points {
        product += (p.0.ln() - x) * (p.1.ln() - y);
        square += (p.0.ln() - x).powi(2);
    }
    product / square
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_of_a_power_is_found() {
        for power in [1.0, 1.5, 2.0] {
            let points = LINKS.map(|n| (n as f64, 3.0 * (n as f64).powf(power)));
            // Rounding of logarithms only.
            assert!((exponent(&points) - power).abs() < 1e-12);
        }
    }
}
