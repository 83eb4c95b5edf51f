//! A covering array of the switches of the physics: every pair of levels that the validation admits is in one row.

/// Two levels: each a factor's number and the level's.
type Pair = ((usize, usize), (usize, usize));

/// One switch with its levels; level 0 is off, or the paper's.
#[derive(Debug)]
pub struct Factor {
    /// Name, for the table.
    pub name: &'static str,
    /// Names of the levels.
    pub levels: &'static [&'static str],
}

pub const STRING: usize = 0;
pub const ROCK: usize = 1;
pub const OUTER: usize = 2;
pub const INNER: usize = 3;
pub const MUD: usize = 4;
pub const FILM: usize = 5;
pub const PRELOAD: usize = 6;
pub const SLOTS: usize = 7;
pub const PRESSURE: usize = 8;
pub const PINS: usize = 9;
pub const PLAY: usize = 10;
pub const SHORTENING: usize = 11;
pub const WELL: usize = 12;
pub const GUIDE: usize = 13;
pub const WEIGHT_AT: usize = 14;
pub const JOINT: usize = 15;
pub const SPINE: usize = 16;

/// The switches. A hoist is there with a string and the rock law `depth_of_cut`.
pub const FACTORS: [Factor; 17] = [
    factor("string", &["none", "line"]),
    factor("rock", &["paper", "weakening", "depth_of_cut"]),
    factor("outer", &["separate", "vector", "bristle"]),
    factor("inner", &["separate", "vector", "bristle"]),
    factor("mud", &["none", "concentric", "eccentric"]),
    factor("film", &["none", "squeeze"]),
    factor("preload", &["as_built", "bent"]),
    factor("slots", &["never", "close"]),
    factor("pressure", &["none", "closed", "sealed", "held"]),
    factor("pins", &["smooth", "rub"]),
    factor("play", &["none", "some"]),
    factor("shortening", &["none", "second_order"]),
    factor("well", &["arc", "straight", "arc_straight"]),
    factor("guide", &["free", "tied"]),
    factor("weight", &["bit", "kickoff"]),
    factor("joint", &["universal", "ball_cage", "revolute"]),
    factor("spine", &["on_axis", "off_axis"]),
];

const fn factor(name: &'static str, levels: &'static [&'static str]) -> Factor {
    Factor { name, levels }
}

/// Level of each factor.
pub type Row = [usize; FACTORS.len()];

/// A pair of levels that cannot be together: (factor, level) twice, and why.
pub type Excluded = ((usize, usize), (usize, usize), &'static str);

/// What the validation refuses; `every_excluded_pair_is_refused` holds each line to the program.
pub const EXCLUDED: [Excluded; 11] = [
    ((STRING, 0), (ROCK, 2), "depth_of_cut needs a string with its hoist"),
    ((ROCK, 2), (WEIGHT_AT, 1), "the hoist holds the weight at the surface"),
    ((MUD, 0), (FILM, 1), "a film needs mud"),
    ((PRESSURE, 1), (GUIDE, 1), "a closed end is free along the axis"),
    ((PRESSURE, 2), (GUIDE, 1), "a sealed end slides"),
    ((PRESSURE, 3), (GUIDE, 0), "a held end is tied to the guide"),
    (
        (WEIGHT_AT, 1),
        (GUIDE, 1),
        "a tied pipe carries a part of the weight at the kick-off",
    ),
    ((WEIGHT_AT, 1), (PRESSURE, 3), "as a tied guide, which a held end needs"),
    ((PINS, 1), (JOINT, 1), "a ball cage has no pins"),
    ((PINS, 1), (JOINT, 2), "a hinge has no cross"),
    ((PLAY, 1), (JOINT, 2), "a hinge has no play"),
];

fn is_admitted(row: &[Option<usize>]) -> bool {
    EXCLUDED
        .iter()
        .all(|&((a, x), (b, y), _)| row[a] != Some(x) || row[b] != Some(y))
}

fn is_excluded(one: (usize, usize), other: (usize, usize)) -> bool {
    EXCLUDED
        .iter()
        .any(|&(a, b, _)| (a, b) == (one, other) || (a, b) == (other, one))
}

/// Pairs of levels of different factors, without those that cannot be together.
fn pairs() -> Vec<Pair> {
    let mut out = Vec::new();
    for (a, first) in FACTORS.iter().enumerate() {
        for (b, second) in FACTORS.iter().enumerate().skip(a + 1) {
            for x in 0..first.levels.len() {
                for y in 0..second.levels.len() {
                    if !is_excluded((a, x), (b, y)) {
                        out.push(((a, x), (b, y)));
                    }
                }
            }
        }
    }
    out
}

/// Number of `open` pairs that a partial row has.
fn gain(open: &[Pair], row: &[Option<usize>]) -> usize {
    open.iter()
        .filter(|&&((a, x), (b, y))| row[a] == Some(x) && row[b] == Some(y))
        .count()
}

/// A row that begins with a pair and takes for each further factor, in the order given by `seed`, the admitted level with
/// the most open pairs. `None` where it runs into a contradiction.
fn grown(open: &[Pair], seed: u64) -> Option<Row> {
    let mut row = [None; FACTORS.len()];
    let ((a, x), (b, y)) = open[seed as usize % open.len().min(7)];
    (row[a], row[b]) = (Some(x), Some(y));
    let mut random = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut order: Vec<usize> = (0..FACTORS.len()).filter(|&f| row[f].is_none()).collect();
    for k in (1..order.len()).rev() {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        order.swap(k, (random >> 33) as usize % (k + 1));
    }
    for f in order {
        row = (0..FACTORS[f].levels.len())
            .map(|level| {
                let mut with = row;
                with[f] = Some(level);
                with
            })
            .filter(|with| is_admitted(with))
            // The lower level where both gain alike, so that a row has no more on than it needs.
            .rev()
            .max_by_key(|with| gain(open, with))?;
    }
    Some(row.map(|level| level.expect("every factor has its level")))
}

/// The array: greedy, with 64 candidates per row, the same on every machine.
///
/// # Panics
/// When a pair that is not excluded fits into no row.
pub fn rows() -> Vec<Row> {
    let mut open = pairs();
    let mut out: Vec<Row> = Vec::new();
    while !open.is_empty() {
        let best = (0..64)
            .filter_map(|seed| grown(&open, seed + 64 * out.len() as u64))
            .max_by_key(|row| gain(&open, &row.map(Some)));
        let row = best.filter(|row| gain(&open, &row.map(Some)) > 0);
        let row = row.unwrap_or_else(|| panic!("no row has any of {open:?}"));
        open.retain(|&((a, x), (b, y))| row[a] != x || row[b] != y);
        out.push(row);
    }
    out
}

/// The levels of a row that are not the first, for a table.
pub fn name(row: &Row) -> String {
    let on: Vec<_> = row
        .iter()
        .zip(&FACTORS)
        .filter(|(level, _)| **level > 0)
        .map(|(&level, factor)| format!("{} {}", factor.name, factor.levels[level]))
        .collect();
    if on.is_empty() {
        "all off".to_owned()
    } else {
        on.join(", ")
    }
}

#[test]
fn the_array_has_every_pair_that_is_admitted() {
    let rows = rows();
    for ((a, x), (b, y)) in pairs() {
        assert!(
            rows.iter().any(|row| row[a] == x && row[b] == y),
            "{} {} with {} {}",
            FACTORS[a].name,
            FACTORS[a].levels[x],
            FACTORS[b].name,
            FACTORS[b].levels[y]
        );
    }
    assert!(rows.iter().all(|row| is_admitted(&row.map(Some))));
    // A quarter of an hour of model time at most: the array is for every run of CI.
    assert!(rows.len() <= 24, "{} rows", rows.len());
}
