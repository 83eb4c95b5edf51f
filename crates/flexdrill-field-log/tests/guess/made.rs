//! Some hundred made logs: no column is proposed as what it is not.

use std::collections::BTreeMap;

use flexdrill_core::inputs::InputKind;
use flexdrill_field_log::{Quantity, Range, guess_bytes, read_bytes};

use crate::rig::{Truth, log};

/// Seeds of the normal run. `FLEXDRILL_GUESSED_LOGS=3000` asks for more.
const SEEDS: u64 = 300;
/// Rows of a log: some connections and circulations long.
const SECONDS: usize = 900;

#[test]
fn no_made_log_has_a_column_that_is_proposed_as_what_it_is_not() {
    let seeds = std::env::var("FLEXDRILL_GUESSED_LOGS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(SEEDS);
    let mut right: BTreeMap<Quantity, u64> = BTreeMap::new();
    let (mut times, mut complete) = (0_u64, 0_u64);
    for seed in 1..=seeds {
        let made = log(seed, SECONDS);
        let guess = guess_bytes(format!("seed {seed}"), made.text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
        let truth_of = |name: &str| &made.columns.iter().find(|(column, _)| column == name).unwrap().1;
        for proposal in guess.proposals() {
            let expected = Truth::Quantity(proposal.quantity, proposal.unit);
            assert_eq!(
                *truth_of(&proposal.column),
                expected,
                "seed {seed}: {proposal:?}\n{}",
                guess.table()
            );
            *right.entry(proposal.quantity).or_default() += 1;
        }
        if let Some((column, format)) = guess.time() {
            match truth_of(&column) {
                Truth::Time(expected) => assert_eq!(format, *expected, "seed {seed}: {column}"),
                other => panic!(
                    "seed {seed}: `{column}` is {other:?} and was proposed as the time\n{}",
                    guess.table()
                ),
            }
            times += 1;
        }
        // Each column has its line, once.
        let proposed = guess.proposals().iter().map(|proposal| &proposal.column);
        let mut said: Vec<&String> = proposed
            .chain(guess.left_out().iter().map(|left| &left.column))
            .collect();
        let count = said.len();
        said.sort();
        said.dedup();
        let time = usize::from(guess.time().is_some());
        assert!(
            said.len() + time >= unique_names(&made.columns) && said.len() == count,
            "seed {seed}\n{}",
            guess.table()
        );
        if guess.lacks().is_empty() {
            complete += 1;
            let mapping = guess
                .mapping()
                .unwrap_or_else(|error| panic!("seed {seed}: {error}\n{}", guess.mapping_file()));
            let read = read_bytes("made".to_owned(), made.text.as_bytes(), &mapping, &Range::ALL);
            let (sequence, _) = read.unwrap_or_else(|error| panic!("seed {seed}: {error}\n{}", guess.mapping_file()));
            let speeds = sequence
                .inputs
                .iter()
                .filter(|input| input.kind == InputKind::RotarySpeed);
            // One field in 200 is empty or a missing code.
            assert!(speeds.count() * 10 > SECONDS * 9, "seed {seed}");
        }
    }
    println!("{seeds} logs: {times} times, {right:?}, {complete} complete");
    // Silence would be right too: of the 80 % of logs that have a quantity, a third have it under a known name with its unit.
    for quantity in Quantity::ALL {
        let found = right.get(&quantity).copied().unwrap_or(0);
        assert!(found * 5 > seeds, "{}: {found} of {seeds}", quantity.name());
    }
    assert!(
        times * 2 > seeds && complete * 8 > seeds,
        "{times} times, {complete} complete of {seeds}"
    );
}

fn unique_names(columns: &[(String, Truth)]) -> usize {
    let mut names: Vec<&String> = columns.iter().map(|(name, _)| name).collect();
    names.sort();
    names.dedup();
    names.len()
}
