//! Values at the ends of a span and inside it, in the numbering of the whole system.

use super::system::CondensedSystem;

/// First unknowns of the nodes at both ends of a span.
pub struct End {
    /// Of the pipe.
    pub pipe: [usize; 2],
    /// Of the guide.
    pub guide: [usize; 2],
}

impl End {
    #[inline(always)]
    pub fn of(system: &CondensedSystem, span: usize) -> Self {
        let layout = system.layout();
        let (top, bottom) = (system.nodes[span], system.nodes[span + 1]);
        let (above, below) = (layout.offset(top.station), layout.offset(bottom.station));
        let start = if top.joint.is_some() { 12 } else { 0 };
        Self {
            pipe: [above + start, below],
            guide: [above + 6, below + 6],
        }
    }

    #[inline(always)]
    pub fn values(&self, first: &[usize; 2], x: &[f64]) -> [f64; 12] {
        let mut out = [0.0; 12];
        out[..6].copy_from_slice(&x[first[0]..first[0] + 6]);
        out[6..].copy_from_slice(&x[first[1]..first[1] + 6]);
        out
    }
}

/// Collects a substructure's values of `nodes` plain stations, twelve apart from `first`; the rest of `to` is zero.
#[inline(always)]
pub fn gather(to: &mut [f64], first: usize, nodes: usize, from: &[f64]) {
    for (k, to) in to.chunks_exact_mut(6).enumerate().take(nodes) {
        to.copy_from_slice(&from[first + 12 * k..first + 12 * k + 6]);
    }
}

/// The way back.
#[inline(always)]
pub fn scatter(from: &[f64], first: usize, nodes: usize, to: &mut [f64]) {
    for (k, from) in from.chunks_exact(6).enumerate().take(nodes) {
        to[first + 12 * k..first + 12 * k + 6].copy_from_slice(from);
    }
}
