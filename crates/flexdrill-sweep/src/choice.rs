//! Which runs of a map to make next, so that few show where the boundary is.
//!
//! Both starts have a process of their own ([`crate::gauss`]). Runs are chosen in rounds: next to the boundary first, which
//! is what a map is read for, then where a run tells most of it. Within a round each choice counts as seen for the next, so
//! that a round does not crowd. The choice depends on the results only, not on who computed them or when.

use crate::gauss::{Process, Surface};
use crate::plan::Grid;

/// The first runs: one cell in this many along each axis, both ends included.
const FIRST_EVERY: usize = 5;
/// Share of cells that may be inferred wrongly when the choice ends, by the process's own confidence.
pub const WRONG: f64 = 0.02;

/// What a run said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// An alarm must be expected.
    Expected,
    /// None must be expected.
    Clear,
    /// Unknown.
    Unknown,
}

/// A map that is being made: what is known per start and cell.
#[derive(Debug, Clone)]
pub struct Choice {
    grid: Grid,
    /// By start, then by cell.
    known: Vec<Vec<Option<Class>>>,
    lengths: Vec<Option<[f64; 2]>>,
}

/// A run: start and cell, by their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Wanted {
    /// Number of the start.
    pub start: usize,
    /// Number of the cell.
    pub cell: usize,
}

impl Choice {
    /// A map of which nothing is known.
    pub fn new(grid: Grid, starts: usize) -> Self {
        let cells = grid.columns * grid.rows;
        Self {
            grid,
            known: vec![vec![None; cells]; starts],
            lengths: vec![None; starts],
        }
    }

    /// Takes a result.
    pub fn learn(&mut self, run: Wanted, class: Class) {
        self.known[run.start][run.cell] = Some(class);
    }

    /// Runs that have a result.
    pub fn runs(&self) -> usize {
        self.known.iter().flatten().filter(|class| class.is_some()).count()
    }

    /// Runs of the whole grid.
    pub fn all(&self) -> usize {
        self.known.len() * self.grid.columns * self.grid.rows
    }

    /// Runs per round: a fortieth of the whole grid.
    fn round(&self) -> usize {
        (self.all() / 40).clamp(4, 64)
    }

    /// The next runs, at most as many as a round has and as `most` allows in all; none when the boundary is known.
    pub fn next(&mut self, most: usize) -> Vec<Wanted> {
        let left = most.saturating_sub(self.runs());
        if self.runs() == 0 {
            let mut first = self.first();
            first.truncate(left);
            return first;
        }
        let mut wanted = Vec::new();
        let mut surfaces: Vec<Vec<Option<Surface>>> = (0..self.known.len()).map(|start| self.surfaces(start)).collect();
        let cells = self.all() as f64;
        let of = |surfaces: &[Vec<Option<Surface>>]| -> f64 {
            surfaces
                .iter()
                .flatten()
                .flatten()
                .map(|surface| 1.0 - surface.confidence())
                .sum()
        };
        if of(&surfaces) <= WRONG * cells && self.on_boundary(&surfaces).is_none() {
            return wanted;
        }
        let mut imagined = self.clone();
        while wanted.len() < self.round().min(left) {
            let Some(run) = imagined.on_boundary(&surfaces).or_else(|| best(&surfaces)) else {
                break;
            };
            wanted.push(run);
            // What is most likely there: it only takes the uncertainty around it away.
            let mean = surfaces[run.start][run.cell].map_or(0.0, |surface| surface.mean);
            imagined.learn(run, if mean > 0.0 { Class::Expected } else { Class::Clear });
            surfaces[run.start] = imagined.surfaces(run.start);
        }
        wanted.sort_unstable();
        wanted
    }

    /// Of the runs that are missing next to a cell of the other class, the one that tells most: a boundary is known when no
    /// such run is missing.
    fn on_boundary(&self, surfaces: &[Vec<Option<Surface>>]) -> Option<Wanted> {
        let mut beside = surfaces.to_vec();
        for (known, cells) in self.known.iter().zip(&mut beside) {
            let expected = |cell: usize| match (known[cell], cells[cell]) {
                (Some(Class::Expected), _) => Some(true),
                (Some(Class::Clear), _) => Some(false),
                (Some(Class::Unknown), _) | (None, None) => None,
                (None, Some(surface)) => Some(surface.mean > 0.0),
            };
            let of = |cell: usize| {
                let other = |near: usize| expected(near).is_some_and(|near| Some(near) != expected(cell));
                self.neighbours(cell).any(other)
            };
            let at: Vec<bool> = (0..cells.len()).map(of).collect();
            for (surface, at) in cells.iter_mut().zip(at) {
                if !at {
                    *surface = None;
                }
            }
        }
        best(&beside)
    }

    /// The cells that share a side with a cell.
    fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let Grid { columns, rows } = self.grid;
        let (column, row) = (cell % columns, cell / columns);
        [
            (column > 0).then(|| cell - 1),
            (column + 1 < columns).then(|| cell + 1),
            (row > 0).then(|| cell - columns),
            (row + 1 < rows).then(|| cell + columns),
        ]
        .into_iter()
        .flatten()
    }

    /// A coarse grid, all starts.
    fn first(&self) -> Vec<Wanted> {
        let along = |count: usize| {
            let parts = count.saturating_sub(1).div_ceil(FIRST_EVERY).max(1);
            (0..=parts)
                .map(move |part| (part * (count - 1) + parts / 2) / parts)
                .collect::<Vec<_>>()
        };
        let mut first = Vec::new();
        for start in 0..self.known.len() {
            for row in along(self.grid.rows) {
                for column in along(self.grid.columns) {
                    let cell = row * self.grid.columns + column;
                    first.push(Wanted { start, cell });
                }
            }
        }
        first.dedup();
        first
    }

    /// Place of a cell in the unit square.
    fn place(&self, cell: usize) -> [f64; 2] {
        let share = |at: usize, count: usize| at as f64 / (count.max(2) - 1) as f64;
        let columns = self.grid.columns;
        [share(cell % columns, columns), share(cell / columns, self.grid.rows)]
    }

    /// What the process of a start says of every cell without a result.
    fn surfaces(&mut self, start: usize) -> Vec<Option<Surface>> {
        let process = self.process(start);
        self.lengths[start] = process.as_ref().map(Process::lengths);
        let inferred = |(cell, class): (usize, &Option<Class>)| match class {
            Some(_) => None,
            None => Some(match &process {
                Some(process) => process.at(self.place(cell)),
                None => Surface {
                    mean: 0.0,
                    deviation: 1.0,
                },
            }),
        };
        self.known[start].iter().enumerate().map(inferred).collect()
    }

    fn process(&self, start: usize) -> Option<Process> {
        let (mut points, mut classes) = (Vec::new(), Vec::new());
        for (cell, class) in self.known[start].iter().enumerate() {
            // What is unknown says nothing of its neighbours.
            let class = match class {
                Some(Class::Expected) => 1.0,
                Some(Class::Clear) => -1.0,
                Some(Class::Unknown) | None => continue,
            };
            points.push(self.place(cell));
            classes.push(class);
        }
        Process::new(&points, &classes, self.lengths[start])
    }

    /// Every cell of a start: the known ones without, the others with what is inferred.
    pub fn inferred(&mut self, start: usize) -> Vec<Option<Surface>> {
        self.surfaces(start)
    }
}

/// The run that tells most.
fn best(surfaces: &[Vec<Option<Surface>>]) -> Option<Wanted> {
    let mut best: Option<(f64, Wanted)> = None;
    for (start, cells) in surfaces.iter().enumerate() {
        for (cell, surface) in cells.iter().enumerate() {
            let Some(surface) = surface else { continue };
            let value = surface.straddle();
            if best.is_none_or(|(most, _)| value > most) {
                best = Some((value, Wanted { start, cell }));
            }
        }
    }
    best.map(|(_, wanted)| wanted)
}
