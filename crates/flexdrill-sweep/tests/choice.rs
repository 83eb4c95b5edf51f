//! Few runs find a boundary that is known; the choice depends on the results only.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_sweep::choice::{Choice, Class, Wanted};
use flexdrill_sweep::plan::Grid;

/// Whether an alarm is to be expected at a place of the unit square, from a start.
type Truth = fn(usize, [f64; 2]) -> bool;

/// A bent front as of whirl; with a start that hangs on longer, as of stick-slip.
fn front(start: usize, [x, y]: [f64; 2]) -> bool {
    y > 0.25 + 0.6 * x * x - if start == 1 { 0.15 } else { 0.0 }
}

/// An island of trouble and a strip at the edge.
fn island(start: usize, [x, y]: [f64; 2]) -> bool {
    let r = if start == 1 { 0.22 } else { 0.27 };
    (x - 0.6).powi(2) + (y - 0.45).powi(2) < r * r || x < 0.12
}

const GRID: Grid = Grid { columns: 16, rows: 14 };

/// The twin's own boundaries, from rest and from running: rotary speed 20 to 120 r/min along the rows, friction between
/// pipe and guide 0.1 to 0.9 from the first row to the last. The command is in `docs/measurements.md`, "Choice of runs".
const TWIN: [[&[u8; 10]; 8]; 2] = [
    [
        b"..........",
        b"..........",
        b"..........",
        b".......###",
        b"......####",
        b".....#####",
        b"....######",
        b"...#######",
    ],
    [
        b"..........",
        b"..........",
        b"..........",
        b"...#######",
        b"...#######",
        b"...#######",
        b".#########",
        b"##########",
    ],
];

fn place(cell: usize, grid: Grid) -> [f64; 2] {
    let (column, row) = (cell % grid.columns, cell / grid.columns);
    [
        column as f64 / (grid.columns - 1) as f64,
        row as f64 / (grid.rows - 1) as f64,
    ]
}

/// Runs, and runs that are inferred wrongly, of all.
fn explore(grid: Grid, truth: impl Fn(usize, usize) -> bool, most: usize) -> (usize, usize, Vec<Wanted>) {
    let mut choice = Choice::new(grid, 2);
    let mut order = Vec::new();
    loop {
        let wanted = choice.next(most);
        if wanted.is_empty() {
            break;
        }
        for run in wanted {
            assert!(!order.contains(&run), "{run:?} twice");
            order.push(run);
            let class = if truth(run.start, run.cell) {
                Class::Expected
            } else {
                Class::Clear
            };
            choice.learn(run, class);
        }
    }
    let mut wrong = 0;
    for start in 0..2 {
        for (cell, surface) in choice.inferred(start).into_iter().enumerate() {
            let class = if truth(start, cell) {
                Class::Expected
            } else {
                Class::Clear
            };
            wrong += usize::from(surface.is_some_and(|surface| surface.likeliest() != class));
        }
    }
    (choice.runs(), wrong, order)
}

#[test]
fn boundaries_are_found_with_two_fifths_of_the_runs() {
    let all = 2 * GRID.columns * GRID.rows;
    for truth in [front as Truth, island] {
        let truth = |start, cell| truth(start, place(cell, GRID));
        let (runs, wrong, order) = explore(GRID, truth, all * 2 / 5);
        println!("{runs} of {all} runs, {wrong} wrong");
        assert!(runs <= all * 2 / 5);
        // 95 % of the cells, of both starts.
        assert!(wrong * 20 <= all, "{wrong} of {all} wrong");
        assert_eq!(explore(GRID, truth, all * 2 / 5).2, order);
    }
}

#[test]
fn boundaries_of_the_twin_are_found_with_two_fifths_of_the_runs() {
    let grid = Grid { columns: 10, rows: 8 };
    let truth = |start: usize, cell: usize| TWIN[start][cell / 10][cell % 10] == b'#';
    let (runs, wrong, _) = explore(grid, truth, 64);
    println!("{runs} of 160 runs, {wrong} wrong");
    // A cell is as the full grid has it when it is so from both starts: 95 % of 80 cells.
    assert!(runs <= 64 && wrong <= 4, "{wrong} of 160 wrong after {runs} runs");
}

#[test]
fn without_a_boundary_few_runs_are_made() {
    for truth in [(|_, _| true) as Truth, |_, _| false] {
        let (runs, wrong, _) = explore(GRID, |start, cell| truth(start, place(cell, GRID)), usize::MAX);
        assert!(runs < 2 * GRID.columns * GRID.rows / 4, "{runs}");
        assert_eq!(wrong, 0);
    }
}

#[test]
fn the_first_runs_hit_every_block_and_every_column() {
    for (columns, rows) in [(2usize, 2usize), (3, 3), (4, 12), (12, 10), (16, 14), (31, 7)] {
        let mut choice = Choice::new(Grid { columns, rows }, 1);
        let first = choice.next(usize::MAX);
        let ran = |column: usize, row: usize| first.iter().any(|run| run.cell == row * columns + column);
        for from in 0..columns.saturating_sub(2) {
            for below in 0..rows.saturating_sub(2) {
                let hit = (from..from + 3).any(|column| (below..below + 3).any(|row| ran(column, row)));
                assert!(hit, "{columns} x {rows}: the block at {from}, {below}");
            }
        }
        // The edges too, where a region may only just begin.
        for row in [0, rows - 1] {
            assert!((0..columns.saturating_sub(2)).all(|from| (from..from + 3).any(|column| ran(column, row))));
        }
        for column in [0, columns - 1] {
            assert!((0..rows.saturating_sub(2)).all(|from| (from..from + 3).any(|row| ran(column, row))));
        }
        if rows > 6 {
            assert!((0..columns).all(|column| (0..rows).any(|row| ran(column, row))));
        }
        assert!(
            first.len() * 3 <= columns * rows || columns * rows < 60,
            "{} runs",
            first.len()
        );
    }
}

/// The boundary of what fails is looked for as that of alarms is: failures are runs like the others, not gaps.
#[test]
fn the_boundary_of_failures_is_found() {
    let truth = |cell: usize| {
        let [x, y] = place(cell, GRID);
        match () {
            () if x + y > 1.3 => Class::Unknown,
            () if y > 0.7 => Class::Expected,
            () => Class::Clear,
        }
    };
    let mut choice = Choice::new(GRID, 1);
    loop {
        let wanted = choice.next(GRID.columns * GRID.rows * 2 / 5);
        if wanted.is_empty() {
            break;
        }
        wanted.into_iter().for_each(|run| choice.learn(run, truth(run.cell)));
    }
    let inferred = choice.inferred(0);
    let known = inferred
        .iter()
        .enumerate()
        .filter_map(|(cell, of)| Some((cell, of.as_ref()?.class()?)));
    let mut failed = 0;
    for (cell, class) in known {
        assert_eq!(class, truth(cell), "cell {cell}");
        failed += usize::from(class == Class::Unknown);
    }
    assert!(failed > 10, "{failed}");
}

#[test]
fn the_budget_is_kept_and_the_smallest_grid_ends() {
    let mut choice = Choice::new(Grid { columns: 2, rows: 2 }, 2);
    let mut runs = 0;
    while let Some(run) = choice.next(3).first().copied() {
        choice.learn(run, Class::Unknown);
        runs += 1;
    }
    assert_eq!((runs, choice.runs()), (3, 3));
    let mut choice = Choice::new(GRID, 1);
    assert_eq!(choice.next(5).len(), 5);
}
