//! The name of a recording, which may contain the time of the start, so that a supervisor can run the same command
//! again without overwriting a recording.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use flexdrill_text::compact_date_time;

/// The placeholder for the time of the start.
const START: &str = "{start}";

/// The path with every `{start}` replaced by the time `now`, UTC, such as `20261122T011019Z`.
pub(super) fn at_start(path: &Path, now: SystemTime) -> PathBuf {
    let Some(text) = path.to_str().filter(|text| text.contains(START)) else {
        return path.to_owned();
    };
    let since = now.duration_since(UNIX_EPOCH).unwrap_or_default();
    let nanoseconds = i64::try_from(since.as_nanos()).unwrap_or_default();
    text.replace(START, &compact_date_time(nanoseconds)).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_placeholder_becomes_the_time_of_the_start() {
        let now = UNIX_EPOCH + Duration::from_secs(1_700_000_000);
        let named = |path: &str| at_start(Path::new(path), now);
        assert_eq!(named("/var/run_{start}"), Path::new("/var/run_20231114T221320Z"));
        assert_eq!(
            named("{start}/{start}.mcap"),
            Path::new("20231114T221320Z/20231114T221320Z.mcap")
        );
        assert_eq!(named("run.mcap"), Path::new("run.mcap"));
    }
}
