//! Energies and forces of the elements over all stations.

use super::EnergyPoint;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::State;
use crate::elements::element_form::{add, load};
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;
use crate::tool::description::Direction;

/// One in the lane of a node's spin.
static SPIN: [f64; 8] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];

/// Forces of the elements and their kinetic energy into `point`. Gives the elastic and geometric energy (J).
pub(super) struct ElementEnergies<'a> {
    pub(super) point: &'a mut EnergyPoint,
    pub(super) model: &'a Model,
    pub(super) state: &'a State,
    pub(super) conditions: &'a Conditions,
}

impl Kernel for ElementEnergies<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self) -> f64 {
        let Self {
            point,
            model,
            state,
            conditions,
        } = self;
        point.geometric.fill(0.0);
        point.damping.fill(0.0);
        point.inertia.fill(0.0);
        let (alpha, beta) = (V::splat(conditions.rayleigh.alpha), V::splat(conditions.rayleigh.beta));
        let zero = V::splat(0.0);
        let (mut elastic, mut geometric, mut kinetic, mut foreseen) = (zero, zero, zero, zero);
        let tensions = state.pipe_axial.iter().chain(&state.guide_axial);
        let at_top = model.pressure_at_top(conditions);
        let unstrained = model
            .pressure
            .as_ref()
            .map(|pressure| &pressure.unstrained[..])
            .unwrap_or_default();
        // With shortening the pipe's axial force is that of its energy: nothing is foreseen, and N G q is no update.
        let later = if model.shortens() { model.pipe.len() } else { 0 };
        for (e, (element, &tension)) in model.elements.list.iter().zip(tensions).enumerate() {
            let forms = &model.elements.kinds[element.kind as usize];
            let nodes = [element.nodes[0] as usize, element.nodes[1] as usize];
            let mut q = forms.to_element::<V>([load(&state.q, nodes[0]), load(&state.q, nodes[1])]);
            // Turning as a whole strains nothing; but hundreds of turns times the rounding of the forces would be as large
            // as what the steps make up.
            let spin = V::splat(-lane(q[0], Direction::Psi as usize));
            q = [
                q[0].plus_product(V::load(&SPIN), spin),
                q[1].plus_product(V::load(&SPIN), spin),
            ];
            let v = forms.to_element::<V>([load(&state.v, nodes[0]), load(&state.v, nodes[1])]);
            let a = forms.to_element::<V>([load(&state.a, nodes[0]), load(&state.a, nodes[1])]);
            let bent = forms.stiffness.product(q);
            let moving = forms.mass.product(v);
            let stiff = forms.stiffness.product(v);
            // Along its axis an element is a spring: its axial force is that on the lower node.
            let (beyond, tension) = if e < later {
                (zero, zero)
            } else {
                let by_pressure = unstrained.get(e).map_or(0.0, |unstrained| at_top * unstrained);
                (V::splat(tension - (lane(bent[1], 0) + by_pressure)), V::splat(tension))
            };
            let mut stretched = forms.geometric.product(q);
            let mut damped = [zero; 2];
            for n in 0..2 {
                foreseen = foreseen.minus_product(v[n], stretched[n].times(beyond));
                stretched[n] = stretched[n].times(tension);
                damped[n] = moving[n].times(alpha).plus_product(stiff[n], beta);
                elastic = elastic.plus_product(q[n], bent[n]);
                geometric = geometric.plus_product(q[n], stretched[n]);
                kinetic = kinetic.plus_product(v[n], moving[n]);
            }
            let inert = forms.to_nodes(forms.mass.product(a));
            let (stretched, damped) = (forms.to_nodes(stretched), forms.to_nodes(damped));
            for n in 0..2 {
                add(&mut point.geometric, nodes[n], stretched[n]);
                add(&mut point.damping, nodes[n], damped[n]);
                add(&mut point.inertia, nodes[n], inert[n]);
            }
        }
        point.kinetic = 0.5 * sum(kinetic);
        point.geometric_energy = 0.5 * sum(geometric);
        point.foresight = sum(foreseen);
        0.5 * sum(elastic) + point.geometric_energy
    }
}

/// Sum of the lanes that belong to a node.
#[inline(always)]
fn sum<V: Vector>(lanes: V) -> f64 {
    let mut out = [0.0; 8];
    lanes.store(&mut out);
    out[..6].iter().sum()
}

/// One lane.
#[inline(always)]
fn lane<V: Vector>(lanes: V, k: usize) -> f64 {
    let mut out = [0.0; 8];
    lanes.store(&mut out);
    out[k]
}
