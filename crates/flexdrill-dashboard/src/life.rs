//! The table of joints' lives for the page: what `flexdrill life show` says, read again when it is old.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use flexdrill_life::{JointOfFile, Lives, MOST_BYTES, Part, UNKNOWN_TO_A_CLASS, damage_with_band};
use flexdrill_text::printable;
use serde_json::{Value, json};

/// Time for which an answer is current: a running node adds to the table once a minute.
const CURRENT: Duration = Duration::from_secs(10);
/// Most joints of an answer, the most damaged first.
const MOST: usize = 200;

/// A table, which all pages share.
pub(crate) struct LifeTable {
    path: PathBuf,
    newest: Mutex<Option<(Instant, Value)>>,
}

impl LifeTable {
    pub fn new(path: PathBuf) -> Self {
        Self {
            path,
            newest: Mutex::default(),
        }
    }

    /// The joints, the most damaged first, or the reason why the table cannot be read. Reads the disk: not for a task.
    pub fn json(&self) -> Value {
        let mut newest = self.newest.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, body)) = newest.as_ref().filter(|(made, _)| made.elapsed() < CURRENT) {
            return body.clone();
        }
        let body = match read(&self.path) {
            Ok(lives) => body(&lives),
            Err(why) => json!({"error": printable(&why), "joints": []}),
        };
        newest.insert((Instant::now(), body)).1.clone()
    }
}

/// Reads a table.
fn read(path: &Path) -> Result<Lives, String> {
    let name = path.display().to_string();
    let mut bytes = Vec::new();
    let opened = File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    opened.map_err(|error| format!("{name}: {error}; `flexdrill life add` or `flexdrill run --life` makes it"))?;
    Lives::from_csv(&name, &bytes).map_err(|error| error.to_string())
}

fn body(lives: &Lives) -> Value {
    let ranked = lives.ranked();
    let joints: Vec<Value> = ranked.iter().take(MOST).map(joint).collect();
    json!({
        "error": null,
        "class": printable(&lives.kind.class),
        "environment": lives.kind.environment.replace('_', " "),
        "runs": lives.runs(),
        "count": ranked.len(),
        "joints": joints,
        "unknown": UNKNOWN_TO_A_CLASS,
    })
}

fn joint(joint: &JointOfFile) -> Value {
    let other = match joint.part {
        Part::Stop => joint.link,
        Part::Link => joint.stop,
    };
    json!({
        "serial": printable(&joint.serial),
        "place": joint.places.last(),
        "hours": joint.hours,
        "runs": joint.runs,
        "part": joint.part.words(),
        "damage": damage_with_band(joint.damage),
        "other": damage_with_band(other),
        "verdict": joint.verdict.words(),
        "level": joint.verdict as u8,
        "hours_left": joint.hours_left,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_config::Config;
    use flexdrill_life::RunLife;

    /// The text of the table is the one of `flexdrill life`, and an answer is current for some seconds.
    #[test]
    fn the_page_has_the_ranking_of_the_table() {
        let text = include_str!("../../../tests/data/small.yaml");
        let serials = "J-1, J-2, J-3, J-4, J-5, J-6";
        let life = format!("joint: {{limit_deg: 6.0, life: {{class: F1}}, serial_numbers: [{serials}]}}");
        let text = text.replace("joint: {limit_deg: 6.0}", &life);
        let config = Config::from_text("small.yaml", &text).unwrap();
        let mut run = RunLife::begun(&config, 1_700_000_000_000_000_000).unwrap();
        run.hours = 2.0;
        run.joints[3].link = 0.5;
        let mut lives = Lives::new("joints.csv", run.kind.clone());
        lives.add(&run, &[], false).unwrap();
        let file = tempfile();
        std::fs::write(&file, lives.to_csv()).unwrap();
        let table = LifeTable::new(file.clone());
        let body = table.json();
        assert_eq!(
            (&body["count"], &body["runs"], &body["error"]),
            (&json!(6), &json!(1), &Value::Null)
        );
        let worst = &body["joints"][0];
        assert_eq!(
            (&worst["serial"], &worst["place"], &worst["level"]),
            (&json!("J-4"), &json!(4), &json!(2))
        );
        let damage = worst["damage"].as_str().unwrap();
        assert!(damage.starts_with("0.50 ("), "{damage}");
        assert!(worst["verdict"].as_str().unwrap().starts_with("A crack is possible"));
        // A file that is gone is said once the answer is old.
        std::fs::remove_file(&file).unwrap();
        assert_eq!(table.json(), body);
        let gone = LifeTable::new(file).json();
        assert!(
            gone["error"].as_str().unwrap().contains("flexdrill run --life"),
            "{gone}"
        );
    }

    /// A name that no other test has.
    fn tempfile() -> PathBuf {
        std::env::temp_dir().join(format!("flexdrill_dashboard_life_{}.csv", std::process::id()))
    }
}
