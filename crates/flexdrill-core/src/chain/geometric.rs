//! The geometric stiffness in the tangent (Eq. 41). Steps leave it out: against the inertia of a step it is small. A tool that
//! comes to rest needs it, because a joint that touches nothing has no other stiffness.

use super::active::Active;
use super::slaving::row;
use super::tangent::{Additions, Touching};
use super::{BOTTOM, ChainModel, TOP};
use crate::dynamics::state::State;

/// Adds N G of every span, with the axial forces of `state`, times `factor`; of the guide alone where an effect has
/// the tension of the pipe, whose tangent has it.
pub(super) fn add_geometric(
    to: &mut Additions<f64>,
    chain: &ChainModel,
    active: &Active,
    state: &State,
    [factor, of_pipe]: [f64; 2],
) {
    for (l, link) in chain.links.iter().enumerate().filter(|(l, _)| active.spans[*l]) {
        let kind = &chain.kinds[link.kind];
        for (body, tension) in [of_pipe * state.pipe_axial[l], state.guide_axial[l]]
            .into_iter()
            .enumerate()
        {
            let (columns, first) = (&kind.geometric[body], 6 * body);
            let (top, bottom) = (&TOP[first..first + 6], &BOTTOM[first..first + 6]);
            let factor = factor * tension;
            for j in 0..6 {
                let [by_top, by_bottom] = [&columns[j], &columns[6 + j]];
                for i in 0..6 {
                    to.block(l, Touching::Both)[top[j]][top[i]] += factor * by_top[row(i)];
                    to.block(l + 1, Touching::Both)[bottom[j]][bottom[i]] += factor * by_bottom[row(6 + i)];
                    let coupling = to.coupling(l, Touching::Both);
                    coupling.upper[first + j][top[i]] += factor * by_bottom[row(i)];
                    coupling.lower[first + j][bottom[i]] += factor * by_top[row(6 + i)];
                }
            }
        }
    }
}
