//! A posterior's sample: what is read and what is refused, and plausible tools drawn from it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod draws;
mod file;

use std::path::Path;

use flexdrill_config::Config;
use flexdrill_uncertainty::posterior::{Provenance, to_csv};
use flexdrill_uncertainty::{Channel, Posterior, PosteriorError, Priors};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

const TOOL: &str = "\
well:
  sections: [{arc: {radius: 3.2, build_angle_deg: 90}}]
  hole_diameter: 0.118
tool:
  links: 33
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118, inertia: 0.01}
calibration: {torque_tare_range_nm: 50}
uncertainty:
  keys:
    - key: contact.inner.friction_tangential
      also: [contact.inner.friction_axial]
      distribution: {log_normal: {low: 0.25, high: 0.40}}
      source: a test
    - {key: tool.bit.friction_factor, form: factor, distribution: {log_normal: {low: 0.8, high: 1.25}}, source: a test}
    - key: contact.outer.friction_tangential
      distribution: {log_normal: {low: 0.25, high: 0.40}}
      source: a test
    - {key: tool.joint.play_deg, distribution: {uniform: {low: 0, high: 1}}, source: a test}
  correlated:
    - {keys: [contact.inner.friction_tangential, contact.outer.friction_tangential], correlation: 0.6}
ensemble: {members: 8, from: {posterior: posterior.csv}}
";
const INNER: [&str; 2] = ["contact.inner.friction_tangential", "contact.inner.friction_axial"];
const BIT: &str = "tool.bit.friction_factor";
const TARE: &str = "calibration.torque_tare_nm";
/// Half of the range of 90 %, in standard deviations.
const BAND: f64 = 1.644_853_626_951_472_2;

fn config() -> Config {
    Config::from_text("test.yaml", TOOL).unwrap()
}

fn provenance(config: &Config, keys: &[&str]) -> Provenance {
    Provenance {
        version: "0.2.0".to_owned(),
        tool: config.tool_hash(keys.iter().copied()),
        configuration: config.hash(),
        log: "rig, of May.csv".to_owned(),
        sha256: "ab".repeat(32),
        rows: [3, 3600],
        seed: 4,
        objections: Vec::new(),
    }
}

fn text(config: &Config, keys: &[&str], rows: &[(f64, Vec<f64>)]) -> String {
    let rows = rows.iter().map(|(weight, values)| (*weight, values.as_slice()));
    to_csv(&provenance(config, keys), keys, rows)
}

fn read(text: &str, config: &Config) -> Result<Posterior, PosteriorError> {
    let read = Posterior::from_csv("posterior.csv", text.as_bytes())?;
    read.belongs_to(config)?;
    Ok(read)
}

/// Ten members of the bit's friction, which the drafts of these tests change.
fn ten() -> String {
    let rows: Vec<(f64, Vec<f64>)> = (0..10).map(|k| (1.0, vec![0.2 + 0.005 * f64::from(k)])).collect();
    text(&config(), &[BIT], &rows)
}

/// A value at a standard normal score of a log-normal prior with 90 % between two ends.
fn log_normal([low, high]: [f64; 2], z: f64) -> f64 {
    (0.5 * (low * high).ln() + 0.5 * (high / low).ln() / BAND * z).exp()
}

/// Standard normal numbers (Box and Muller).
fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}
