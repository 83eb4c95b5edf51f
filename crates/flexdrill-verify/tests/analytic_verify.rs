//! Every closed-form case of `flexdrill verify` is within its limit.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_verify::{CASES, Row};

#[test]
fn all_cases_are_within_their_limits() {
    let rows: Vec<Row> = CASES
        .iter()
        .flat_map(|case| (case.run)().unwrap_or_else(|error| panic!("{error}")))
        .collect();
    let off: Vec<String> = rows.iter().filter(|row| !row.passed()).map(Row::to_string).collect();
    assert!(off.is_empty(), "{}\n{}", flexdrill_verify::title(), off.join("\n"));
    // Each case compares at least one number.
    assert!(CASES.iter().all(|case| rows.iter().any(|row| row.case == case.name)));
}

#[test]
fn a_wrong_number_is_noticed() {
    let row = Row::relative("case", "quantity", 2.0, 2.1, 0.01);
    assert!(!row.passed() && (row.error() - 0.05).abs() < 1e-12);
    let nothing = Row::relative("case", "quantity", 2.0, f64::NAN, 0.01);
    assert!(!nothing.passed(), "NaN is no agreement");
}
