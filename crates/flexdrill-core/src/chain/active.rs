//! The active part of the tool in a correction: all of it, or windows around the nodes that are out of balance.
//!
//! After two corrections most nodes are in balance; a few joints that have just opened or shut are not. A window linearises
//! these and the nodes below them and solves for them; afterwards only the parts that moved are evaluated, and the rest of
//! the residual keeps its values. Above a window the elimination of an earlier correction is valid; it gives the motion of
//! the nodes there, which is followed upward until the force on the next node is small. Below a window nothing moves. Any
//! error of this appears in the residual, by which every step is judged.

use super::NODE;

/// Corrections of the whole tool before the first one in windows.
pub(super) const WHOLE_CORRECTIONS: u32 = 2;
/// Nodes below one that is out of balance that are solved for with it.
const BELOW: usize = 6;

/// A run of nodes that are solved for together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    /// First and last node that are linearised and eliminated.
    pub first: usize,
    pub last: usize,
    /// First node that moves.
    pub top: usize,
}

/// The active part of the tool.
#[derive(Debug, Clone)]
pub(super) struct Active {
    /// Whether it is the whole tool.
    pub whole: bool,
    /// From the top down; no two touch.
    pub windows: Vec<Window>,
    /// Nodes that are linearised.
    pub nodes: Vec<bool>,
    /// Spans with an end that is linearised or, once solved for, moves.
    pub spans: Vec<bool>,
    /// Nodes whose residual changes.
    pub affected: Vec<bool>,
}

impl Active {
    pub(super) fn new(nodes: usize) -> Self {
        let mut active = Self {
            whole: false,
            windows: Vec::with_capacity(nodes),
            nodes: vec![true; nodes],
            spans: vec![true; nodes - 1],
            affected: vec![true; nodes],
        };
        active.set_whole();
        active
    }

    /// The whole tool.
    pub(super) fn set_whole(&mut self) {
        if self.whole {
            return;
        }
        self.whole = true;
        self.windows.clear();
        self.windows.push(Window {
            first: 0,
            last: self.nodes.len() - 1,
            top: 0,
        });
        self.nodes.fill(true);
        self.spans.fill(true);
        self.affected.fill(true);
    }

    /// Windows around the nodes that are out of balance, `weights` being one over the limits of `residual`.
    pub(super) fn set_windows(&mut self, residual: &[f64], weights: &[f64]) {
        self.whole = false;
        self.windows.clear();
        let bottom = self.nodes.len() - 1;
        let ((residual, _), (weights, _)) = (residual.as_chunks::<NODE>(), weights.as_chunks::<NODE>());
        for (first, (residual, weights)) in residual.iter().zip(weights).enumerate() {
            let mut balanced = true;
            for (r, w) in residual.iter().zip(weights) {
                balanced &= r.abs() * w <= 1.0;
            }
            if balanced {
                continue;
            }
            let last = (first + BELOW).min(bottom);
            match self.windows.last_mut() {
                Some(above) if first <= above.last + 1 => above.last = last,
                _ => self.windows.push(Window {
                    first,
                    last,
                    top: first,
                }),
            }
        }
        self.nodes.fill(false);
        self.spans.fill(false);
        for window in &self.windows {
            self.nodes[window.first..=window.last].fill(true);
            self.spans[window.first.saturating_sub(1)..(window.last + 1).min(bottom)].fill(true);
        }
    }

    /// Marks the nodes and spans that the solution moves.
    pub(super) fn moved(&mut self) {
        if self.whole {
            return;
        }
        let bottom = self.nodes.len() - 1;
        self.spans.fill(false);
        self.affected.fill(false);
        for window in &self.windows {
            let (above, below) = (window.top.saturating_sub(1), (window.last + 1).min(bottom));
            self.spans[above..below].fill(true);
            self.affected[above..=below].fill(true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marks of the nodes in ranges.
    fn marks(nodes: usize, ranges: &[std::ops::Range<usize>]) -> Vec<bool> {
        (0..nodes)
            .map(|k| ranges.iter().any(|range| range.contains(&k)))
            .collect()
    }

    #[test]
    fn windows_lie_around_what_is_out_of_balance() {
        let mut residual = vec![0.5; NODE * 30];
        let weights = vec![1.0; NODE * 30];
        // Two that meet, one by itself, one at the bottom.
        for (node, value) in [(2, 2.0), (7, -2.0), (16, 1.1), (28, f64::NAN)] {
            residual[NODE * node + node % NODE] = value;
        }
        let mut active = Active::new(30);
        assert!(active.whole);
        active.set_windows(&residual, &weights);
        let ends: Vec<_> = active
            .windows
            .iter()
            .map(|window| (window.first, window.last))
            .collect();
        assert_eq!(ends, [(2, 13), (16, 22), (28, 29)]);
        assert_eq!(active.nodes, marks(30, &[2..14, 16..23, 28..30]));
        assert_eq!(active.spans, marks(29, &[1..14, 15..23, 27..29]));
        // The second one moves up into the first.
        active.windows[1].top = 11;
        active.moved();
        assert_eq!(active.spans, marks(29, &[1..23, 27..29]));
        assert_eq!(active.affected, marks(30, &[1..24, 27..30]));
        active.set_whole();
        assert_eq!(active.windows.len(), 1);
        assert!(
            active
                .nodes
                .iter()
                .chain(&active.spans)
                .chain(&active.affected)
                .all(|&mark| mark)
        );
    }
}
