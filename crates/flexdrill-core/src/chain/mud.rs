//! Mud near the walls at all stations of the chain: its forces on the ends of the spans, its tangent, its energy.

use super::Chain;
use super::columns::{EndColumn, load, plus_column, store};
use crate::dynamics::energy::EnergyPoint;
use crate::elements::mud_wall::{Motion, NearWall, Taken};
use crate::simd::Kernel;
use crate::simd::number::{Eight, Lane, Number};
use crate::simd::vector::Vector;

/// How the stations of a span, one per lane, move: the pipe in the guide, and the guide in the hole.
pub(super) type MudMotions = [Motion<Lane>; 2];

impl<V: Vector> Motion<Eight<V>> {
    /// Writes all lanes to memory.
    #[inline(always)]
    pub(super) fn store(self, to: &mut Motion<Lane>) {
        for k in 0..2 {
            self.d[k].store(&mut to.d[k]);
            self.v[k].store(&mut to.v[k]);
            self.a[k].store(&mut to.a[k]);
        }
    }

    /// Reads all lanes from memory.
    #[inline(always)]
    fn load(from: &Motion<Lane>) -> Self {
        Self {
            d: [Eight::load(&from.d[0]), Eight::load(&from.d[1])],
            v: [Eight::load(&from.v[0]), Eight::load(&from.v[1])],
            a: [Eight::load(&from.a[0]), Eight::load(&from.a[1])],
        }
    }
}

/// What mud takes at eight stations.
#[inline(always)]
fn take<V: Vector>(near: &NearWall<Lane>, motion: &Motion<Lane>) -> Taken<Eight<V>> {
    let near = NearWall {
        mass: Eight::<V>::load(&near.mass),
        film: Eight::load(&near.film),
        per_square: Eight::load(&near.per_square),
    };
    near.take(&Motion::load(motion))
}

/// Adds to the ends of a span, pipe and guide, what the force of both annuli at its stations, lane by lane, comes to there.
#[inline(always)]
fn on_ends<V: Vector>(chain: &Chain, l: usize, [inner, outer]: [[Eight<V>; 2]; 2], to: &mut [EndColumn; 2]) {
    let mut lanes = [Lane::default(); 4];
    for k in 0..2 {
        inner[k].store(&mut lanes[k]);
        outer[k].store(&mut lanes[2 + k]);
    }
    let force = &chain.model.kinds[chain.model.links[l].kind].force;
    let [mut pipe, mut guide]: [[V; 2]; 2] = [load(&to[0]), load(&to[1])];
    for (lane, rows) in force.iter().skip(1).enumerate() {
        for k in 0..2 {
            let (inner, outer) = (lanes[k][lane], lanes[2 + k][lane]);
            pipe = plus_column(pipe, &rows[0][1 + k], V::splat(inner));
            guide = plus_column(guide, &rows[1][1 + k], V::splat(outer - inner));
        }
    }
    store(pipe, &mut to[0]);
    store(guide, &mut to[1]);
}

impl Chain {
    /// Adds what mud near the walls takes to the forces of the contacts, of spans that moved.
    #[inline(always)]
    pub(super) fn add_mud_forces<V: Vector>(&mut self) {
        for l in 0..self.mud.len() {
            let Some(near) = self.model.links[l].mud.as_ref().filter(|_| self.active.spans[l]) else {
                continue;
            };
            let motions = &self.mud[l];
            let taken = [take::<V>(&near[0], &motions[0]), take::<V>(&near[1], &motions[1])];
            let mut total = [taken[0].film, taken[1].film];
            for (total, taken) in total.iter_mut().zip(&taken) {
                for (sum, inertia) in total.iter_mut().zip(&taken.inertia) {
                    *sum = *sum + *inertia;
                }
            }
            let mut forces = self.contact_forces[l].0;
            on_ends(self, l, total, &mut forces);
            self.contact_forces[l].0 = forces;
        }
    }

    /// Adds inertia, kinetic energy and damping of mud near the walls to `point`.
    pub(super) fn add_mud_energy(&self, point: &mut EnergyPoint) {
        if !self.mud.is_empty() {
            self.model.instructions.run(MudEnergy { chain: self, point });
        }
    }
}

struct MudEnergy<'a> {
    chain: &'a Chain,
    point: &'a mut EnergyPoint,
}

impl Kernel for MudEnergy<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { chain, point } = self;
        for (l, (link, motions)) in chain.model.links.iter().zip(&chain.mud).enumerate() {
            let Some(near) = &link.mud else { continue };
            let taken = [take::<V>(&near[0], &motions[0]), take::<V>(&near[1], &motions[1])];
            let mut energy = Lane::default();
            (taken[0].energy + taken[1].energy).store(&mut energy);
            point.kinetic += energy.iter().sum::<f64>();
            let inertia = [taken[0].inertia, taken[1].inertia];
            on_ends(chain, l, inertia, &mut point.spans[l].inertia);
            let mut film = [[0.0; 16]; 2];
            on_ends(chain, l, [taken[0].film, taken[1].film], &mut film);
            for (body, film) in film.iter().enumerate() {
                super::energy::add(&mut point.mud, super::columns::ends(l, body), film);
            }
        }
    }
}
