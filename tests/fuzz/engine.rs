//! Runs a target with bytes made from seeds: each execution is a pure function of its number, bounded in time and
//! memory.

use std::fs::File;
use std::os::unix::fs::FileExt as _;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use peak_alloc::PeakAlloc;

use crate::mutator::{mutate, random};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Longest time for one input. The machine may be busy, so that the best of three counts.
const LONGEST: Duration = Duration::from_secs(1);
/// An input that has not ended after this never will.
const HANGS: Duration = Duration::from_secs(30);
/// Most memory asked for at a time, by Rust code, beyond what was there before (bytes). Inputs have at most 64 kB,
/// those of checkpoints some hundred; a frame that announces 16 MiB is the largest of what a few bytes may ask for.
const MOST_MEMORY: usize = 64 << 20;
/// One target at a time: memory is counted for the whole process.
static ONE: Mutex<()> = Mutex::new(());

/// What is fuzzed.
pub struct Target<'a> {
    /// Of the test, and of its folder in tests/data/fuzz.
    pub name: &'static str,
    /// Inputs that are accepted as they are.
    pub seeds: Vec<Vec<u8>>,
    /// What the format is made of.
    pub words: &'a [&'a str],
    /// Whether it accepts the bytes; panics when it does not treat them as it must.
    pub run: &'a mut dyn FnMut(&[u8]) -> bool,
}

impl Target<'_> {
    /// Runs seeds and kept cases, then mutations of them until the time is over.
    pub fn fuzz(mut self) {
        let _alone = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        let watch = Watch::start(self.name);
        let folder = folder(self.name);
        let mut largest = 0;
        for (index, seed) in self.seeds.clone().iter().enumerate() {
            let accepted = self.execute(seed, &format!("seed input {index}"), &mut largest);
            assert!(accepted, "{}: seed input {index} is not accepted", self.name);
        }
        for path in kept(&folder) {
            let input = std::fs::read(&path).unwrap();
            self.execute(&input, &path.display().to_string(), &mut largest);
            self.seeds.push(input);
        }
        let first: u64 = number("FLEXDRILL_FUZZ_SEED").unwrap_or(1);
        let time = Duration::from_secs(number("FLEXDRILL_FUZZ_SECONDS").unwrap_or(2));
        let (began, mut accepted, mut seed) = (Instant::now(), 0_u64, first);
        while began.elapsed() < time {
            watch.at(seed);
            let input = mutate(&self.seeds, self.words, &mut random(seed));
            let again = format!("FLEXDRILL_FUZZ_SEED={seed}");
            accepted += u64::from(self.execute(&input, &again, &mut largest));
            seed += 1;
        }
        watch.at(0);
        println!(
            "{}: {} executions, {accepted} accepted, at most {} kB asked for",
            self.name,
            seed - first,
            largest >> 10
        );
    }

    fn execute(&mut self, input: &[u8], origin: &str, largest: &mut usize) -> bool {
        let before = ALLOCATOR.current_usage();
        ALLOCATOR.reset_peak_usage();
        let began = Instant::now();
        let result = catch_unwind(AssertUnwindSafe(|| (self.run)(input)));
        let mut took = began.elapsed();
        let asked = ALLOCATOR.peak_usage().saturating_sub(before);
        *largest = asked.max(*largest);
        let accepted = match result {
            Ok(accepted) => accepted,
            Err(panic) => {
                self.keep(input, origin, "panics");
                resume_unwind(panic);
            }
        };
        for _ in 0..2 {
            if took > LONGEST {
                let began = Instant::now();
                (self.run)(input);
                took = took.min(began.elapsed());
            }
        }
        if took > LONGEST {
            self.keep(input, origin, "is slow");
            panic!("{}: {took:?} for {} bytes", self.name, input.len());
        }
        if asked > MOST_MEMORY {
            self.keep(input, origin, "asks for memory");
            panic!("{}: {asked} bytes of memory for {} bytes", self.name, input.len());
        }
        accepted
    }

    /// Leaves an input to look at.
    fn keep(&self, input: &[u8], origin: &str, what: &str) {
        let path = scratch().join(format!("{}_found", self.name));
        std::fs::write(&path, input).unwrap();
        eprintln!(
            "{}: an input {what}; again with {origin} cargo test --release --features full --test fuzz {}; once mended, keep {} in {}",
            self.name,
            self.name,
            path.display(),
            folder(self.name).display()
        );
    }
}

fn number(variable: &str) -> Option<u64> {
    std::env::var(variable).ok().map(|value| value.parse().unwrap())
}

fn scratch() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/fuzz").join(name)
}

/// Cases that were found, in the order of their names.
fn kept(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    paths
}

/// Knows which execution runs, also where it takes the process with it.
struct Watch {
    seed: Arc<AtomicU64>,
    file: File,
}

impl Watch {
    fn start(name: &'static str) -> Self {
        let path = scratch().join(format!("{name}_seed"));
        let seed = Arc::new(AtomicU64::new(0));
        let watched = Arc::clone(&seed);
        std::thread::spawn(move || {
            let mut last = (0, Instant::now());
            // The only other holder is the target.
            while Arc::strong_count(&watched) > 1 {
                let now = watched.load(Ordering::Relaxed);
                if now == 0 || now != last.0 {
                    last = (now, Instant::now());
                } else if last.1.elapsed() > HANGS {
                    eprintln!("{name}: FLEXDRILL_FUZZ_SEED={now} does not end");
                    std::process::abort();
                }
                std::thread::sleep(Duration::from_millis(200));
            }
        });
        Self {
            seed,
            file: File::create(path).unwrap(),
        }
    }

    fn at(&self, seed: u64) {
        self.seed.store(seed, Ordering::Relaxed);
        // For what no process survives, such as a stack that is too small.
        self.file.write_all_at(format!("{seed:20}\n").as_bytes(), 0).unwrap();
    }
}
