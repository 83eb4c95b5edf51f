//! Runs that need nothing of each other, made on threads; those that are done can be kept in a folder, so that a study of hours
//! can be interrupted and continued.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};

use serde::{Deserialize, Serialize};

/// A run to be made.
pub trait Work: Sync {
    /// What it brings.
    type Found: Clone + Send;

    /// What it costs, in any unit.
    fn cost(&self) -> f64;

    /// What its result is a function of, as the name of a file and as texts: the hash of its configuration, and all else. `None`
    /// for one that is not worth keeping.
    fn kept_as(&self) -> Option<KeptAs>;

    /// Makes it. `report` gets the share that is done, 0 to 1.
    ///
    /// # Errors
    /// Why there is no result, in words.
    fn run(&self, report: &mut impl FnMut(f64)) -> Result<Self::Found, String>;

    /// The numbers of a result; not a number where there is none.
    fn figures(found: &Self::Found) -> Vec<f64>;

    /// The result with these numbers.
    fn found(figures: Vec<f64>) -> Option<Self::Found>;
}

/// How a run is kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeptAs {
    /// Name of the file, without its ending.
    pub name: String,
    /// Hash of the configuration.
    pub config: String,
    /// What else the result is a function of.
    pub load: String,
}

/// A run that is done cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct KeepError {
    path: PathBuf,
    source: std::io::Error,
}

/// A folder of runs that are done, a file each. A file of anything else than the run that is asked for, or of another version,
/// counts as absent.
#[derive(Debug)]
pub struct Kept(PathBuf);

/// What a file has. Numbers are written as text, which reads back to the bit, also where they are none.
#[derive(Serialize, Deserialize)]
struct Part {
    version: String,
    config: String,
    load: String,
    found: Result<Vec<String>, String>,
}

impl Kept {
    /// Runs in `folder`, which is created if necessary.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn open(folder: &Path) -> Result<Self, KeepError> {
        std::fs::create_dir_all(folder).map_err(|source| KeepError {
            path: folder.to_owned(),
            source,
        })?;
        Ok(Self(folder.to_owned()))
    }

    /// The numbers of a run, or why it has none; `None` where it is not kept.
    fn read(&self, as_: &KeptAs) -> Option<Result<Vec<f64>, String>> {
        let text = std::fs::read_to_string(self.path(as_)).ok()?;
        let part: Part = serde_json::from_str(&text).ok()?;
        if part.version != env!("CARGO_PKG_VERSION") || part.config != as_.config || part.load != as_.load {
            return None;
        }
        let number = |figure: &String| figure.parse::<f64>().ok();
        match part.found {
            Ok(figures) => Some(Ok(figures.iter().map(number).collect::<Option<_>>()?)),
            Err(cause) => Some(Err(cause)),
        }
    }

    /// Writes a run, under a temporary name first, so that no file is ever incomplete.
    fn write(&self, as_: &KeptAs, found: Result<Vec<f64>, String>) -> Result<(), KeepError> {
        let part = Part {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            config: as_.config.clone(),
            load: as_.load.clone(),
            found: found.map(|figures| figures.iter().map(f64::to_string).collect()),
        };
        let path = self.path(as_);
        let temporary = path.with_extension("part");
        serde_json::to_string(&part)
            .map_err(std::io::Error::from)
            .and_then(|text| std::fs::write(&temporary, text))
            .and_then(|()| std::fs::rename(&temporary, &path))
            .map_err(|source| KeepError { path, source })
    }

    fn path(&self, as_: &KeptAs) -> PathBuf {
        self.0.join(format!("{}.json", as_.name))
    }
}

/// The result of a run: that which is kept, or the run itself, which is then kept.
fn result<W: Work>(
    work: &W,
    kept: Option<&Kept>,
    report: &mut impl FnMut(f64),
) -> (Result<W::Found, String>, Result<(), KeepError>) {
    // What a result is a function of may be long to write down.
    let Some((kept, as_)) = kept.and_then(|kept| Some((kept, work.kept_as()?))) else {
        return (work.run(report), Ok(()));
    };
    let known = match kept.read(&as_) {
        Some(Ok(figures)) => W::found(figures).map(Ok),
        Some(Err(cause)) => Some(Err(cause)),
        None => None,
    };
    known.map_or_else(
        || {
            let result = work.run(report);
            let written = kept.write(&as_, result.as_ref().map(W::figures).map_err(Clone::clone));
            (result, written)
        },
        |known| (known, Ok(())),
    )
}

/// Makes all runs on `jobs` threads. The results are in the order of the runs and do not depend on the number of threads. At
/// most one run per thread is in memory. `progress` gets the share of the cost that is done, 0 to 1. Runs that are `kept` are not
/// made, and every run is kept.
///
/// # Errors
/// When a run cannot be kept. A run that fails is part of the results.
pub fn run_all<W: Work>(
    runs: &[W],
    jobs: usize,
    kept: Option<&Kept>,
    mut progress: impl FnMut(f64),
) -> Result<Vec<Result<W::Found, String>>, KeepError> {
    // The most expensive runs come first, so that no thread waits for one at the end.
    let mut order: Vec<usize> = (0..runs.len()).collect();
    order.sort_by(|a, b| runs[*b].cost().total_cmp(&runs[*a].cost()));
    let whole: f64 = runs.iter().map(W::cost).sum();
    let next = AtomicUsize::new(0);
    let found = Mutex::new(vec![None; runs.len()]);
    let unkept = Mutex::new(None);
    std::thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel::<f64>();
        for _ in 0..jobs.clamp(1, runs.len().max(1)) {
            let (sender, order, next, found, unkept) = (sender.clone(), &order, &next, &found, &unkept);
            scope.spawn(move || {
                while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let work = &runs[index];
                    let mut reported = 0.0;
                    // Only the increase is sent, as all threads share one sum.
                    let mut report = |share: f64| {
                        // The receiver outlives all threads of this scope.
                        let _ = sender.send((share - reported) * work.cost());
                        reported = share;
                    };
                    let (result, written) = result(work, kept, &mut report);
                    if let Err(error) = written {
                        *unkept.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                        // What cannot be kept is not worth hours.
                        next.store(order.len(), Ordering::Relaxed);
                    }
                    // A run that was kept reports its whole share here; one that ended early, the rest.
                    report(1.0);
                    found.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(result);
                }
            });
        }
        // The loop below ends with the last sender of the threads.
        drop(sender);
        let mut done = 0.0;
        for part in receiver {
            done += part;
            progress((done / whole).min(1.0));
        }
    });
    if let Some(error) = unkept.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(error);
    }
    let found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    let none = || Err("the run did not take place".to_owned());
    Ok(found.into_iter().map(|found| found.unwrap_or_else(none)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that brings these numbers, or fails.
    struct Known {
        name: &'static str,
        load: &'static str,
        brings: Result<Vec<f64>, String>,
        made: AtomicUsize,
    }

    impl Work for Known {
        type Found = Vec<f64>;

        fn cost(&self) -> f64 {
            self.name.len() as f64
        }

        fn kept_as(&self) -> Option<KeptAs> {
            (!self.name.is_empty()).then(|| KeptAs {
                name: self.name.to_owned(),
                config: "hash".to_owned(),
                load: self.load.to_owned(),
            })
        }

        fn run(&self, report: &mut impl FnMut(f64)) -> Result<Vec<f64>, String> {
            self.made.fetch_add(1, Ordering::Relaxed);
            report(0.5);
            self.brings.clone()
        }

        fn figures(found: &Vec<f64>) -> Vec<f64> {
            found.clone()
        }

        fn found(figures: Vec<f64>) -> Option<Vec<f64>> {
            Some(figures)
        }
    }

    fn known(name: &'static str, load: &'static str, brings: Result<&[f64], &str>) -> Known {
        Known {
            name,
            load,
            brings: brings.map(<[f64]>::to_vec).map_err(str::to_owned),
            made: AtomicUsize::new(0),
        }
    }

    #[test]
    fn runs_are_made_once_and_read_back_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let kept = Kept::open(folder.path()).unwrap();
        let numbers = [0.1 + 0.2, 1e-300, -1.0 / 3.0, f64::MIN_POSITIVE, 0.0, 1e300, f64::NAN];
        let runs = [
            known("a", "", Ok(&numbers)),
            known("longer", "", Err("a reason")),
            known("", "", Ok(&[1.0])),
        ];
        let made = || {
            runs.iter()
                .map(|run| run.made.load(Ordering::Relaxed))
                .collect::<Vec<_>>()
        };
        let bits = |results: Vec<Result<Vec<f64>, String>>| -> Vec<Result<Vec<u64>, String>> {
            let of = |found: Vec<f64>| found.into_iter().map(f64::to_bits).collect();
            results.into_iter().map(|result| result.map(of)).collect()
        };
        let mut shares = Vec::new();
        let first = bits(run_all(&runs, 2, Some(&kept), |share| shares.push(share)).unwrap());
        assert_eq!(shares.last(), Some(&1.0));
        assert_eq!(first[1], Err("a reason".to_owned()));
        assert_eq!(made(), [1, 1, 1]);
        // The one that is not kept is made again, with the same results.
        assert_eq!(bits(run_all(&runs, 1, Some(&kept), |_| ()).unwrap()), first);
        assert_eq!(made(), [1, 1, 2]);
        // Without a folder all are made, and a run of something else has another result.
        assert_eq!(bits(run_all(&runs, 3, None, |_| ()).unwrap()), first);
        assert_eq!(made(), [2, 2, 3]);
        let other = [known("a", "another load", Ok(&[7.0]))];
        assert_eq!(run_all(&other, 1, Some(&kept), |_| ()).unwrap(), [Ok(vec![7.0])]);
    }

    #[test]
    fn a_folder_that_cannot_be_written_ends_it() {
        let folder = tempfile::tempdir().unwrap();
        let kept = Kept::open(&folder.path().join("points")).unwrap();
        std::fs::remove_dir_all(folder.path().join("points")).unwrap();
        let error = run_all(&[known("a", "", Ok(&[1.0]))], 1, Some(&kept), |_| ()).unwrap_err();
        assert!(error.to_string().starts_with("cannot write "), "{error}");
    }
}
