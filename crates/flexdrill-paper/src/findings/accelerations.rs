//! Accelerations: Fig. 16 and 17.

use super::finding::{Finding, Paper, ratio};
use crate::record::Record;

pub(super) fn findings(record: &Record) -> Vec<Finding> {
    let effective = |squares: &[Vec<f64>; 3], k: usize| squares[k].iter().fold(0.0_f64, |m, &x| m.max(x)).sqrt();
    let pipe = [0, 1, 2].map(|k| effective(&record.pipe.acceleration_square, k));
    let guide = [0, 1, 2].map(|k| effective(&record.guide.acceleration_square, k));
    let words = |a: [f64; 3]| format!("x {:.2}, y {:.2}, z {:.2} m/s2", a[0], a[1], a[2]);
    vec![
        ratio(
            Paper {
                key: "lateral",
                figure: "16",
                says: "the pipe's lateral (y) acceleration dominates",
                definition: "largest RMS acceleration of a station along y over the larger of x and z",
            },
            words(pipe),
            pipe[1] / pipe[0].max(pipe[2]).max(f64::MIN_POSITIVE),
            [1.1, 0.9],
            "ratio",
        ),
        ratio(
            Paper {
                key: "pipe_over_guide",
                figure: "17",
                says: "the pipe's acceleration is larger than the guide's",
                definition: "largest RMS acceleration of the pipe along y over the guide's",
            },
            format!(
                "pipe {:.2}, guide {:.2} m/s2 (guide: {})",
                pipe[1],
                guide[1],
                words(guide)
            ),
            pipe[1] / guide[1].max(f64::MIN_POSITIVE),
            [1.2, 1.0],
            "ratio",
        ),
    ]
}
