//! Which runs of a map to make next, so that few show where the boundaries are, and what the others are inferred to be.
//!
//! Every start has separate processes ([`crate::gauss`]), one per class: a run that failed is a class with its own boundary,
//! not a gap. Runs are chosen in rounds: next to a failure that stands alone and next to a boundary first, which is what a map
//! is read for, then where a run shows most of a cell that is not known. Within a round each choice counts as seen for the
//! next, so that a round does not crowd. The choice depends on the results only, not on who computed them or when.

use crate::cover::{Cover, SIDE};
use crate::gauss::{CLASSES, Process, Shape, Surface};
use crate::map::{OfStart, SURE};
use crate::plan::Grid;

/// The shape of the processes is chosen again after one run more in so many: choosing takes 48 factorisations.
const FEW: usize = 5;
/// Share of cells that may be inferred wrongly when the choice ends, by the process's own confidence.
pub const WRONG: f64 = 0.02;

/// What a run said. The numbers are those of the processes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// An alarm must be expected.
    Expected,
    /// None must be expected.
    Clear,
    /// Unknown: it failed, so that nothing says what would have come.
    Unknown,
}

/// What a cell without a run is inferred to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inferred {
    surface: Surface,
    /// Probability from which on the cell is clear.
    sure: f64,
    /// Whether the runs around it allow to infer that it is clear ([`crate::cover`]).
    may_be_clear: bool,
}

impl Inferred {
    /// Probability that a run would show a class and none of the others.
    pub fn probability(&self, class: Class) -> f64 {
        self.surface.probability(class as usize)
    }

    /// The class that is most likely. Among equal ones the order is unknown, alarm, clear: no knowledge is never clear.
    pub fn likeliest(&self) -> Class {
        let probability = |class: &Class| self.probability(*class);
        let order = [Class::Clear, Class::Expected, Class::Unknown];
        let likeliest = order
            .into_iter()
            .max_by(|a, b| probability(a).total_cmp(&probability(b)));
        likeliest.unwrap_or(Class::Unknown)
    }

    /// The class, where it is known: for an alarm and for a failure with a probability of [`SURE`]. A cell is clear only
    /// where it is clear from all starts, so that each of n starts needs the n-th root of it, and runs around the cell.
    pub fn class(&self) -> Option<Class> {
        let class = self.likeliest();
        let is_sure = match class {
            Class::Clear => self.may_be_clear && self.probability(class) >= self.sure,
            Class::Expected | Class::Unknown => self.probability(class) >= SURE,
        };
        is_sure.then_some(class)
    }

    /// The cell's state in a map. A run that would probably fail is not known either: nothing says what would come there.
    pub fn of_start(&self) -> OfStart {
        let confidence = self.probability(self.likeliest());
        match self.class() {
            Some(Class::Clear) => OfStart::inferred(false, confidence),
            Some(Class::Expected) => OfStart::inferred(true, confidence),
            Some(Class::Unknown) | None => OfStart::not_known(confidence),
        }
    }

    /// How much a run here shows of a boundary.
    fn tells(&self) -> f64 {
        let of = (0..CLASSES).map(|class| self.surface.straddle(class));
        of.fold(f64::NEG_INFINITY, f64::max)
    }
}

/// What is inferred of every start's cells; nothing where a run was made.
type Map = Vec<Vec<Option<Inferred>>>;

/// A map that is being made: what is known per start and cell.
#[derive(Debug, Clone)]
pub struct Choice {
    grid: Grid,
    /// By start, then by cell.
    known: Vec<Vec<Option<Class>>>,
    /// The shape of each start's processes, and the runs that it was chosen by.
    shapes: Vec<Option<(Shape, usize)>>,
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
            shapes: vec![None; starts],
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

    /// The next runs, at most as many as a round has and as `most` allows in all; none when the boundaries are known.
    pub fn next(&mut self, most: usize) -> Vec<Wanted> {
        let left = most.saturating_sub(self.runs());
        if self.runs() == 0 {
            return self.first(left);
        }
        let mut wanted = Vec::new();
        let mut map: Map = (0..self.known.len()).map(|start| self.surfaces(start)).collect();
        let inferred = || map.iter().flatten().flatten();
        let doubtful: f64 = inferred().map(|cell| 1.0 - cell.probability(cell.likeliest())).sum();
        let is_known = doubtful <= WRONG * self.all() as f64 && inferred().all(|cell| cell.class().is_some());
        if is_known && self.on_boundary(&map, true).is_none() {
            return wanted;
        }
        let mut imagined = self.clone();
        while wanted.len() < self.round().min(left) {
            let run = imagined.beside_alone(&map);
            let run = run.or_else(|| imagined.on_boundary(&map, false));
            let run = run.or_else(|| imagined.on_boundary(&map, true));
            let run = run.or_else(|| best(&map, |_, _, cell| cell.class().is_none()));
            let Some(run) = run.or_else(|| best(&map, |_, _, _| true)) else {
                break;
            };
            wanted.push(run);
            // What is most likely there: it only takes the uncertainty around it away.
            let likeliest = map[run.start][run.cell].map_or(Class::Unknown, |cell| cell.likeliest());
            imagined.learn(run, likeliest);
            map[run.start] = imagined.surfaces(run.start);
        }
        wanted.sort_unstable();
        wanted
    }

    /// Of the missing neighbours of failures that stand alone, the one that shows most.
    fn beside_alone(&self, map: &Map) -> Option<Wanted> {
        let beside = self.known.iter().map(|known| {
            let mut beside = vec![false; known.len()];
            for cell in Cover::new(self.grid, known).alone() {
                self.neighbours(cell).for_each(|near| beside[near] = true);
            }
            beside
        });
        let beside: Vec<Vec<bool>> = beside.collect();
        best(map, |start, cell, _| beside[start][cell])
    }

    /// Of the runs that are missing next to a cell of another class, the one that shows most: a boundary is known when no
    /// such run is missing. Without `any`, only the boundary of the clear cells counts.
    fn on_boundary(&self, map: &Map, any: bool) -> Option<Wanted> {
        let classes = self.known.iter().zip(map).map(|(known, cells)| {
            let of = known.iter().zip(cells);
            of.map(|(known, cell)| known.or_else(|| cell.map(|cell| cell.likeliest())))
                .collect()
        });
        let classes: Vec<Vec<Option<Class>>> = classes.collect();
        best(map, |start, cell, _| {
            let own = classes[start][cell];
            self.neighbours(cell).any(|near| {
                let other = classes[start][near];
                other != own && (any || own == Some(Class::Clear) || other == Some(Class::Clear))
            })
        })
    }

    /// Runs that ended and have a cell of another class next to them, by start and cell: there a class is least certain. With
    /// `known`, only classes of runs count, otherwise those that are most likely elsewhere too.
    pub fn next_to_others(&mut self, known: bool) -> Vec<Wanted> {
        let mut found = Vec::new();
        for start in 0..self.known.len() {
            let inferred = if known { Vec::new() } else { self.surfaces(start) };
            let class = |cell: usize| {
                let likeliest = || Some(inferred.get(cell)?.as_ref()?.likeliest());
                self.known[start][cell].or_else(likeliest)
            };
            let of_run = self.known[start].iter().enumerate();
            let ended =
                of_run.filter_map(|(cell, class)| Some((cell, class.filter(|class| *class != Class::Unknown)?)));
            let next = ended.filter(|(cell, own)| {
                let mut others = self.neighbours(*cell).filter_map(class);
                others.any(|other| other != *own)
            });
            found.extend(next.map(|(cell, _)| Wanted { start, cell }));
        }
        found
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

    /// The first runs, of all starts, at most `most`: they hit every block of [`SIDE`] by [`SIDE`] cells, up to the edges of
    /// the map, and every column where there are enough rows, so that no column of failures (a resonance at one speed) is
    /// missed.
    fn first(&self, most: usize) -> Vec<Wanted> {
        let Grid { columns, rows } = self.grid;
        let parts = rows.saturating_sub(1).div_ceil(SIDE).max(1);
        let mut cells = Vec::new();
        for part in 0..=parts.min(rows - 1) {
            let row = (part * (rows - 1) + parts / 2) / parts;
            let of_row = |column: &usize| {
                let is_end = *column == 0 || column + 1 == columns;
                is_end || (column + part).is_multiple_of(SIDE)
            };
            cells.extend((0..columns).filter(of_row).map(|column| row * columns + column));
        }
        // Where not all are allowed, as many as are, all over the map.
        let count = cells.len().min(most.div_ceil(self.known.len().max(1)));
        let mut first: Vec<Wanted> = (0..count)
            .map(|at| cells[at * cells.len() / count])
            .flat_map(|cell| (0..self.known.len()).map(move |start| Wanted { start, cell }))
            .collect();
        first.truncate(most);
        first.sort_unstable();
        first
    }

    /// Place of a cell in the unit square.
    fn place(&self, cell: usize) -> [f64; 2] {
        let share = |at: usize, count: usize| at as f64 / (count.max(2) - 1) as f64;
        let columns = self.grid.columns;
        [share(cell % columns, columns), share(cell / columns, self.grid.rows)]
    }

    /// What the processes of a start say of every cell without a result.
    fn surfaces(&mut self, start: usize) -> Vec<Option<Inferred>> {
        let runs = self.known[start].iter().flatten().count();
        // Runs that are imagined within a round are fewer, so that they do not change the shape.
        let kept = self.shapes[start].filter(|(_, chosen)| runs < chosen + (chosen / FEW).max(self.round() + 1));
        let process = self.process(start, kept.map(|(shape, _)| shape));
        self.shapes[start] = process
            .as_ref()
            .map(|process| (process.shape(), kept.map_or(runs, |(_, chosen)| chosen)));
        let known = &self.known[start];
        // What failed from one start may fail from another: no cell next to it is clear from either.
        let failed = |cell: usize| self.known.iter().any(|of| of[cell] == Some(Class::Unknown));
        let of_all = known.iter().enumerate();
        let of_all = of_all.map(|(cell, own)| if failed(cell) { Some(Class::Unknown) } else { *own });
        let may_be_clear = Cover::new(self.grid, &of_all.collect::<Vec<_>>()).may_be_clear();
        let sure = SURE.powf(1.0 / self.known.len() as f64);
        let inferred = |(cell, class): (usize, &Option<Class>)| match class {
            Some(_) => None,
            None => Some(Inferred {
                surface: process
                    .as_ref()
                    .map_or(Surface::NOTHING, |process| process.at(self.place(cell))),
                sure,
                may_be_clear: may_be_clear[cell],
            }),
        };
        known.iter().enumerate().map(inferred).collect()
    }

    fn process(&self, start: usize, shape: Option<Shape>) -> Option<Process> {
        let known = self.known[start].iter().enumerate();
        let (points, classes): (Vec<_>, Vec<_>) = known
            .filter_map(|(cell, class)| Some((self.place(cell), (*class)? as usize)))
            .unzip();
        match shape {
            Some(shape) => Process::with(&points, &classes, shape),
            None => Process::new(&points, &classes),
        }
    }

    /// Every cell of a start: the known ones without, the others with what is inferred.
    pub fn inferred(&mut self, start: usize) -> Vec<Option<Inferred>> {
        // By all runs.
        self.shapes[start] = None;
        self.surfaces(start)
    }
}

/// The run that shows most, of those that are `wanted` by start, cell and what is inferred there.
fn best(map: &Map, wanted: impl Fn(usize, usize, &Inferred) -> bool) -> Option<Wanted> {
    let mut best: Option<(f64, Wanted)> = None;
    for (start, cells) in map.iter().enumerate() {
        for (cell, inferred) in cells.iter().enumerate() {
            let Some(inferred) = inferred else { continue };
            let tells = inferred.tells();
            if best.is_none_or(|(most, _)| tells > most) && wanted(start, cell, inferred) {
                best = Some((tells, Wanted { start, cell }));
            }
        }
    }
    best.map(|(_, wanted)| wanted)
}
