//! `--cases memory`: whether memory grows while the model runs.

use flexdrill_bench::machine::status_kb;
use flexdrill_bench::measure::{Load, run};
use flexdrill_bench::table::Table;
use flexdrill_config::Config;

/// Model time between two samples (s).
const EVERY: f64 = 60.0;
/// Minutes that the table shows, in addition to the last.
const SHOWN: [usize; 8] = [1, 2, 5, 10, 20, 30, 45, 60];

/// Runs for `duration` (s) and samples the resident set; gives the table.
///
/// # Errors
/// When the tool cannot be built, a step fails, or the system does not show the memory.
pub(crate) fn tables(config: &Config, load: Load, duration: f64) -> anyhow::Result<String> {
    // Allocated before the run, so that the samples themselves do not show.
    let mut samples: Vec<u64> = Vec::with_capacity((duration / EVERY) as usize + 1);
    let mut next = EVERY;
    eprintln!("memory: {duration} s of model time");
    let measured = run(config, load, duration, |time| {
        // Frames are exact to rounding; a sample may be a frame late.
        if time + 1e-9 >= next {
            samples.push(status_kb("VmRSS:").unwrap_or(0));
            next += EVERY;
        }
    })?;
    if let Some(failure) = measured.failure {
        anyhow::bail!("a step failed at model time {} s: {failure}", failure.time);
    }
    let (Some(&first), Some(&largest)) = (samples.first(), samples.iter().max()) else {
        anyhow::bail!("--duration {duration}: at least {EVERY} s, the time between two samples");
    };
    if first == 0 {
        anyhow::bail!("this system does not show the memory of a process in /proc/self/status");
    }
    let mut table = Table::new(["after model time", "resident memory"]);
    for (index, kb) in samples.iter().enumerate() {
        let minute = index + 1;
        if SHOWN.contains(&minute) || minute == samples.len() {
            table.row([format!("{minute} min"), format!("{kb} kB")]);
        }
    }
    Ok(format!(
        "`VmRSS` of the process at each of {} minutes of model time ({:.0} s of wall time), {} links x {} elements, {} r/min, {} kN. Largest less first: {} kB.\n\n{}",
        samples.len(),
        measured.wall,
        config.tool.links,
        config.tool.elements_per_link,
        load.rpm,
        load.wob,
        largest - first,
        table.text()
    ))
}
