//! Files of results that are complete whenever they are there.

use std::path::Path;

use anyhow::Context as _;

/// Writes a file under a temporary name first, so that the final name never has a part of it.
///
/// # Errors
/// When the folder is missing or the disk refuses.
pub(super) fn write(folder: &Path, name: &str, text: &str) -> anyhow::Result<()> {
    let path = folder.join(name);
    let temporary = folder.join(format!(".{name}.{}", std::process::id()));
    let written = std::fs::write(&temporary, text).and_then(|()| std::fs::rename(&temporary, &path));
    if written.is_err() {
        // The error of the write is the one to report.
        let _ = std::fs::remove_file(&temporary);
    }
    written.with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    use flexdrill_config::Config;
    use flexdrill_uncertainty::Posterior;
    use flexdrill_uncertainty::posterior::{FILE, Provenance, to_csv};

    /// Folder in which the process of this test writes, where the test has started it for that.
    const WRITES_IN: &str = "FLEXDRILL_TEST_WRITES_IN";

    /// A sample of as many members as the reader takes, so that writing takes most of the writer's time.
    fn sample(friction: f64) -> String {
        let key = "contact.outer.friction_tangential";
        let config = Config::from_text("default.yaml", include_str!("../../config/default.yaml")).unwrap();
        let provenance = Provenance {
            tool: config.tool_hash([key]),
            configuration: config.hash(),
            sha256: "ab".repeat(32),
            rows: [1, 100],
            ..Provenance::default()
        };
        let values: Vec<[f64; 1]> = (0..100_000).map(|row| [friction + 1e-7 * f64::from(row)]).collect();
        let rows = values.iter().map(|row| (1.0, row.as_slice()));
        to_csv(&provenance, &[key], rows)
    }

    /// Names in a folder that are temporary ones of the file.
    fn temporaries(folder: &Path) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let is_temporary = |path: &PathBuf| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            name.starts_with(&format!(".{FILE}."))
        };
        entries.filter(is_temporary).collect()
    }

    /// A process that writes posterior.csv again and again is killed in the middle: there is no file or a whole one, which is
    /// one of the two that it writes in turn.
    #[test]
    fn a_process_that_is_killed_while_it_writes_leaves_a_whole_file_or_none() {
        let samples = [0.2, 0.3].map(sample);
        if let Some(folder) = std::env::var_os(WRITES_IN) {
            // The parent kills this process long before.
            let end = Instant::now() + Duration::from_secs(60);
            for text in samples.iter().cycle().take_while(|_| Instant::now() < end) {
                super::write(Path::new(&folder), FILE, text).unwrap();
            }
            return;
        }
        let (_, module) = module_path!().split_once("::").unwrap();
        let name = format!("{module}::a_process_that_is_killed_while_it_writes_leaves_a_whole_file_or_none");
        let (mut in_the_middle, mut whole) = (0, 0);
        for kill in 0..12_u32 {
            let folder = tempfile::tempdir().unwrap();
            let mut child = Command::new(std::env::current_exe().unwrap())
                .args(["--exact", &name])
                .env(WRITES_IN, folder.path())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            // The first kills come within the first file, the others later.
            let begun = Instant::now();
            while temporaries(folder.path()).is_empty() && !folder.path().join(FILE).exists() {
                assert!(begun.elapsed() < Duration::from_secs(60), "the writer does not begin");
                std::thread::sleep(Duration::from_micros(200));
            }
            std::thread::sleep(Duration::from_micros(2700 * u64::from(kill)));
            child.kill().unwrap();
            child.wait().unwrap();
            in_the_middle += u32::from(!temporaries(folder.path()).is_empty());
            match std::fs::read(folder.path().join(FILE)) {
                Ok(bytes) => {
                    whole += 1;
                    assert!(
                        samples.iter().any(|text| text.as_bytes() == bytes),
                        "{} bytes",
                        bytes.len()
                    );
                    let posterior = Posterior::from_csv(FILE, &bytes).unwrap();
                    assert_eq!(posterior.members().len(), 100_000);
                }
                Err(error) => assert_eq!(error.kind(), std::io::ErrorKind::NotFound),
            }
        }
        // Otherwise nothing was tested: the writer does little else than write.
        assert!(
            in_the_middle > 0 && whole > 0,
            "{in_the_middle} in the middle, {whole} whole"
        );
    }
}
