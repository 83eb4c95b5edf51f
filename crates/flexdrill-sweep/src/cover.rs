//! What the runs around a cell must show before the cell may be inferred clear.
//!
//! A process knows nothing of a region that no run has hit, and what cannot be computed is the worst to miss. So a cell is
//! inferred clear only where
//! - every block of [`SIDE`] by [`SIDE`] cells that touches the cell or a neighbour of it, and is cut by the edge of the map,
//!   holds a run;
//! - no run within [`SIDE`] cells of it failed;
//! - the runs that failed form regions: of the other runs within [`SIDE`] cells of each at least a quarter failed, and a block
//!   next to it has failed runs only. Where failures are scattered, any cell may be one, and none is inferred clear.
//!
//! From the first two follows: where every failing cell belongs to a block that fails as a whole, or touches one, no failing
//! cell is inferred clear, whatever the processes say. That block holds a run by the first rule, this run failed, and it is
//! within [`SIDE`] cells, which the second rule excludes.

use crate::choice::Class;
use crate::plan::Grid;

/// Cells along the side of a block; the first runs hit every block of this size.
pub const SIDE: usize = 3;

/// The classes of the runs of one start, by cell.
#[derive(Debug, Clone, Copy)]
pub struct Cover<'a> {
    grid: Grid,
    known: &'a [Option<Class>],
}

/// The runs of a block.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    ended: usize,
    failed: usize,
}

impl<'a> Cover<'a> {
    /// Of the runs of a grid's cells.
    pub const fn new(grid: Grid, known: &'a [Option<Class>]) -> Self {
        Self { grid, known }
    }

    /// Whether each cell may be inferred clear.
    pub fn may_be_clear(&self) -> Vec<bool> {
        let blocks = self.blocks();
        let scattered = self.failed().any(|cell| !self.is_of_region(cell, &blocks));
        let may = |cell: usize| {
            let covered = self
                .touching(cell)
                .all(|block| blocks[block].ended + blocks[block].failed > 0);
            covered && !self.within(cell).any(|near| self.has_failed(near))
        };
        (0..self.known.len()).map(|cell| !scattered && may(cell)).collect()
    }

    /// Runs that failed without another one within [`SIDE`] cells: their neighbours show whether they belong to a region.
    pub fn alone(&self) -> Vec<usize> {
        self.failed().filter(|cell| self.is_alone(*cell)).collect()
    }

    fn has_failed(&self, cell: usize) -> bool {
        self.known[cell] == Some(Class::Unknown)
    }

    fn failed(&self) -> impl Iterator<Item = usize> + use<'_> {
        (0..self.known.len()).filter(|cell| self.has_failed(*cell))
    }

    fn is_alone(&self, cell: usize) -> bool {
        !self.within(cell).any(|near| near != cell && self.has_failed(near))
    }

    /// Whether enough of the other runs around the cell failed, and a block next to the cell, or with it, has failed runs only.
    /// A quarter is what a run at the corner of a large region has.
    fn is_of_region(&self, cell: usize, blocks: &[Block]) -> bool {
        let others = self
            .within(cell)
            .filter(|near| *near != cell && self.known[*near].is_some());
        let (failed, ended): (Vec<usize>, Vec<usize>) = others.partition(|near| self.has_failed(*near));
        let is_one_of_many = !failed.is_empty() && failed.len() * 3 >= ended.len();
        let is_whole = |block: usize| blocks[block].failed > 0 && blocks[block].ended == 0;
        is_one_of_many && self.touching(cell).any(is_whole)
    }

    /// Cells within [`SIDE`] cells along both axes, this one included.
    fn within(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let Grid { columns, rows } = self.grid;
        let (column, row) = (cell % columns, cell / columns);
        let about = |at: usize, count: usize| at.saturating_sub(SIDE)..(at + SIDE + 1).min(count);
        about(row, rows).flat_map(move |row| about(column, columns).map(move |column| row * columns + column))
    }

    /// Blocks along an axis: from the one that has only the first cell to the one that has only the last.
    const fn along(count: usize) -> usize {
        count + SIDE - 1
    }

    /// Numbers of the blocks that touch a cell or a neighbour of it. Block `i` has the cells from `i + 1 - SIDE` to `i`.
    fn touching(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let Grid { columns, rows } = self.grid;
        let (column, row) = (cell % columns, cell / columns);
        let about = |at: usize, count: usize| at.saturating_sub(1)..(at + SIDE + 1).min(Self::along(count));
        about(row, rows)
            .flat_map(move |row| about(column, columns).map(move |column| row * Self::along(columns) + column))
    }

    fn blocks(&self) -> Vec<Block> {
        let Grid { columns, rows } = self.grid;
        let width = Self::along(columns);
        let mut blocks = vec![Block::default(); width * Self::along(rows)];
        for (cell, class) in self.known.iter().enumerate() {
            let Some(class) = class else { continue };
            for row in cell / columns..cell / columns + SIDE {
                for column in cell % columns..cell % columns + SIDE {
                    let block = &mut blocks[row * width + column];
                    match class {
                        Class::Unknown => block.failed += 1,
                        Class::Expected | Class::Clear => block.ended += 1,
                    }
                }
            }
        }
        blocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs as a picture: `c` clear, `a` alarm, `x` failed, `.` not run. The result in the same form: `o` may be clear.
    fn may(picture: &str) -> String {
        let rows: Vec<&str> = picture.split_whitespace().collect();
        let grid = Grid {
            columns: rows[0].len(),
            rows: rows.len(),
        };
        let known: Vec<Option<Class>> = rows
            .concat()
            .bytes()
            .map(|byte| match byte {
                b'c' => Some(Class::Clear),
                b'a' => Some(Class::Expected),
                b'x' => Some(Class::Unknown),
                _ => None,
            })
            .collect();
        let may = Cover::new(grid, &known).may_be_clear();
        let text: Vec<String> = may
            .chunks(grid.columns)
            .map(|row| row.iter().map(|may| if *may { 'o' } else { '.' }).collect())
            .collect();
        text.join(" ")
    }

    #[test]
    fn a_cell_needs_runs_all_around_up_to_the_edge() {
        assert_eq!(may("c..c ..c. .... c..c"), "oooo oooo oooo oooo");
        // The last column could fail as a whole.
        assert_eq!(may("c..cc. ...... ...... c..cc."), "oooo.. oooo.. oooo.. oooo..");
        assert_eq!(may(".... .... .... ...."), ".... .... .... ....");
    }

    #[test]
    fn no_cell_next_to_a_region_that_failed_may_be_clear() {
        let lattice = "x..c..c..c xx........ .......... x..c..c..c .......... .......... c..c..c..c";
        // Three cells from the failures at columns 0 and 1, of which the second ends with row 1.
        let free = ".....ooooo .....ooooo .....ooooo .....ooooo .....ooooo ....oooooo ....oooooo";
        assert_eq!(may(lattice), free);
    }

    #[test]
    fn scattered_failures_leave_no_cell_clear() {
        let none = |picture: &str| assert!(!may(picture).contains('o'), "{picture}");
        // Alone, although the neighbours have not been run.
        none("c..c..c .....c. ....... c..c..x ....... ....... c..c..c");
        // Two of them, each amid runs that ended.
        none("c..c..c ..c.... .cxcc.. c.cxc.c ...c... ....... c..c..c");
    }
}
