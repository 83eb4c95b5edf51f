//! Published figures: source, figure, ours, tolerance and its reason are in `flexdrill_verify::VALIDATIONS`, and in
//! docs/validation.md.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_verify::VALIDATIONS;

fn hold(name: &str) {
    let validation = VALIDATIONS.iter().find(|validation| validation.name == name).unwrap();
    let rows = (validation.run)().unwrap();
    assert!(!rows.is_empty());
    for row in &rows {
        println!("{row}");
        assert!(row.passed(), "{row}");
    }
}

/// Euler and Eytelwein, 1.170 to 1.875; tolerance 0.1 %, as the table says.
#[test]
fn val_capstan_with_advance() {
    hold("val_capstan_with_advance");
}

/// Dawson and Paslay, 2.798 kN; tolerance 1 %, as the table says.
#[test]
fn val_sinusoidal_buckling() {
    hold("val_sinusoidal_buckling");
}

/// Chen, Lin and Cheatham, 3.957 kN; tolerance 3 %, as the table says.
#[test]
fn val_helical_buckling() {
    hold("val_helical_buckling");
}

/// welleng 0.30.0, 1602 to 3500 N; tolerance 0.1 %, as the table says.
#[test]
fn val_soft_string_of_welleng() {
    hold("val_soft_string_of_welleng");
}

/// Every entry of the table has a test of its name here.
#[test]
fn the_table_has_no_figure_without_a_test() {
    let tests = include_str!("validation.rs");
    for validation in VALIDATIONS {
        let test = format!(
            "#[test]\nfn {}() {{\n    hold(\"{}\");",
            validation.name, validation.name
        );
        assert!(tests.contains(&test), "{}", validation.name);
    }
}
