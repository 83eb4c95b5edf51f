//! The clear part of a map as a safe operating envelope: for every value of one quantity the least and the most of the
//! other, and the reverse. Both hold together; their intersection has clear cells only: cells that were run, or inferred with
//! 95 %. What is unknown or not known is in no envelope.

use crate::map::{Map, Verdict};

/// Bounds of one quantity for every value of the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    /// Values of the other quantity.
    pub at: Vec<f64>,
    /// Least and most allowed; nothing where no value is clear.
    pub bounds: Vec<Option<[f64; 2]>>,
}

/// A safe operating envelope.
#[derive(Debug, Clone, PartialEq)]
pub struct Envelope {
    /// Bounds of y for every x.
    pub of_y: Bounds,
    /// Bounds of x for every y.
    pub of_x: Bounds,
}

impl Envelope {
    /// Of the largest connected clear part of a map. Cells that are inferred clear count if `inferred` is set. The bounds
    /// are values of the axes, the outermost that are clear.
    pub fn of(map: &Map, inferred: bool) -> Self {
        let (columns, rows) = (map.x.values.len(), map.y.values.len());
        let clear: Vec<bool> = map
            .cells
            .iter()
            .map(|cell| {
                let ran = cell.starts.iter().all(|start| start.state == crate::map::Origin::Known);
                cell.verdict == Verdict::Clear && (ran || inferred)
            })
            .collect();
        let part = largest_part(&clear, columns);
        let has = |column: usize, row: usize| part[row * columns + column];
        let along = |count: usize, values: &[f64], has: &dyn Fn(usize) -> bool| {
            longest(count, has).map(|[first, last]| [values[first], values[last]])
        };
        Self {
            of_y: Bounds {
                at: map.x.values.clone(),
                bounds: (0..columns)
                    .map(|column| along(rows, &map.y.values, &|row| has(column, row)))
                    .collect(),
            },
            of_x: Bounds {
                at: map.y.values.clone(),
                bounds: (0..rows)
                    .map(|row| along(columns, &map.x.values, &|column| has(column, row)))
                    .collect(),
            },
        }
    }
}

/// First and last of the longest uninterrupted run; the first of equally long ones.
fn longest(count: usize, has: &dyn Fn(usize) -> bool) -> Option<[usize; 2]> {
    let mut best: Option<[usize; 2]> = None;
    let mut begun = None;
    for at in 0..=count {
        if at < count && has(at) {
            begun.get_or_insert(at);
        } else if let Some(first) = begun.take() {
            let length = at - first;
            if best.is_none_or(|[from, to]| length > to + 1 - from) {
                best = Some([first, at - 1]);
            }
        }
    }
    best
}

/// The largest part whose cells touch along edges; the first of equally large ones.
fn largest_part(cells: &[bool], columns: usize) -> Vec<bool> {
    let mut part = vec![0usize; cells.len()];
    let mut sizes = vec![0usize];
    for first in 0..cells.len() {
        if !cells[first] || part[first] != 0 {
            continue;
        }
        let number = sizes.len();
        sizes.push(0);
        let mut open = vec![first];
        part[first] = number;
        while let Some(cell) = open.pop() {
            sizes[number] += 1;
            let column = cell % columns;
            let near = [
                (column > 0).then(|| cell - 1),
                (column + 1 < columns).then(|| cell + 1),
                cell.checked_sub(columns),
                Some(cell + columns).filter(|below| *below < cells.len()),
            ];
            for next in near.into_iter().flatten() {
                if cells[next] && part[next] == 0 {
                    part[next] = number;
                    open.push(next);
                }
            }
        }
    }
    let largest = (1..sizes.len()).rev().max_by_key(|number| sizes[*number]).unwrap_or(0);
    part.iter().map(|number| largest > 0 && *number == largest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_run_and_the_largest_part_are_found() {
        let run = |text: &str| longest(text.len(), &|at| text.as_bytes()[at] == b'x');
        assert_eq!(run("x.xx."), Some([2, 3]));
        assert_eq!(run("xx.xx"), Some([0, 1]));
        assert_eq!((run("..."), run("xxx")), (None, Some([0, 2])));
        // Two parts that touch at a corner only.
        let cells = "xx..\nxx..\n..xx\n..x.\n..xx".split('\n').collect::<String>();
        let cells: Vec<bool> = cells.bytes().map(|byte| byte == b'x').collect();
        let part = largest_part(&cells, 4);
        let count = part.iter().filter(|cell| **cell).count();
        assert_eq!((part[0], part[10], count), (false, true, 5));
    }
}
