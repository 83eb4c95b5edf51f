//! Mud near the walls of both annuli, at all stations: what it takes beyond small motion about the centre, by the [`law`] of an
//! annulus, on the ends of the spans.

mod law;

use std::f64::consts::PI;
use std::sync::Arc;

use super::mud::Annulus;
use crate::chain::columns::{EndColumn, load, plus_column, store};
use crate::chain::{Additions, Chain, Effect, Precision, SpanMotion, Under, add_to_ends};
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::State;
use crate::elements::factors::TangentFactors;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::number::{Eight, Lane, Number};
use crate::simd::vector::Vector;
use crate::tool::{AddedMass, MudDescription, MudFilm, ToolDescription, Tube};

pub(crate) use law::{Motion, NearWall, Taken};

/// Of both annuli along an element with this `pipe`, [pipe in guide, guide in hole], per length.
fn per_length(mud: &MudDescription, d: &ToolDescription, pipe: &Tube) -> [NearWall; 2] {
    let annuli = [
        [pipe.outer_diameter, d.guide_section.inner_diameter],
        [d.guide_section.outer_diameter, d.hole_diameter],
    ];
    annuli.map(|diameters| {
        let [a, b] = diameters.map(|diameter| 0.5 * diameter);
        let width = b - a;
        NearWall {
            mass: if mud.added_mass == AddedMass::Eccentric {
                Annulus::of(mud, a, b).mass
            } else {
                0.0
            },
            film: if mud.film == MudFilm::Squeeze {
                12.0 * PI * mud.viscosity * (a / width).powi(3)
            } else {
                0.0
            },
            per_square: 1.0 / (width * width),
        }
    })
}

/// Both annuli at each station; empty where mud near walls does not count. The first station, where the tool is held, has none.
pub(crate) fn at_stations(model: &Model) -> Vec<[NearWall; 2]> {
    let d = &model.description;
    let counts = |mud: &&MudDescription| mud.added_mass == AddedMass::Eccentric || mud.film == MudFilm::Squeeze;
    let Some(mud) = d.mud.as_ref().filter(counts) else {
        return Vec::new();
    };
    let of_sections: Vec<[NearWall; 2]> = d.pipe_sections.iter().map(|pipe| per_length(mud, d, pipe)).collect();
    let mut stations: Vec<[NearWall; 2]> = vec![Default::default(); model.guide.len() + 1];
    for (e, element) in model.guide.iter().enumerate() {
        let half = 0.5 * element.beam.length;
        for station in stations[e..e + 2].iter_mut().skip(usize::from(e == 0)) {
            for (to, of) in station.iter_mut().zip(&of_sections[e % d.elements_per_link]) {
                to.mass += half * of.mass;
                to.film += half * of.film;
                // Where two sections meet, the narrower one counts.
                to.per_square = to.per_square.max(of.per_square);
            }
        }
    }
    stations
}

/// The mud near the walls of both annuli, at all stations of a chain.
#[derive(Clone)]
pub(crate) struct MudWall {
    /// Per span, its stations but the first, one per lane.
    walls: Arc<[[NearWall<Lane>; 2]]>,
    /// How the pipe moves in the guide there, and the guide in the hole.
    motions: Vec<[Motion<Lane>; 2]>,
}

impl MudWall {
    /// Of a tool whose mud counts near the walls.
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        let stations = at_stations(model);
        if stations.is_empty() {
            return None;
        }
        let walls = (0..chain.spans()).map(|l| {
            let mut lanes = <[NearWall<Lane>; 2]>::default();
            for (i, station) in chain.stations_below(l).enumerate() {
                for (lanes, at) in lanes.iter_mut().zip(&stations[station]) {
                    lanes.set_lane(i, at);
                }
            }
            lanes
        });
        Some(Self {
            walls: walls.collect(),
            motions: vec![<[Motion<Lane>; 2]>::default(); chain.spans()],
        })
    }

    /// What it takes in span `l`, in the lanes of its stations: from the pipe in the guide, and from the guide in the hole.
    #[inline(always)]
    fn taken<V: Vector>(&self, l: usize) -> [Taken<Eight<V>>; 2] {
        let (walls, motions) = (&self.walls[l], &self.motions[l]);
        [take(&walls[0], &motions[0]), take(&walls[1], &motions[1])]
    }
}

impl Effect for MudWall {
    fn force(&mut self, chain: &mut Chain, state: &mut State, _under: &Under<'_>) {
        let instructions = chain.model.instructions;
        instructions.run(Forces {
            effect: self,
            chain,
            state,
        });
    }

    fn tangent<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, _state: &State, at: &Iteration<'_>) {
        chain.model.instructions.run(Tangents {
            effect: self,
            to,
            chain,
            factors: at.factors,
        });
    }

    fn energy(&self, chain: &Chain, point: &mut LedgerPoint, _state: &State, _under: &Under<'_>) -> f64 {
        let instructions = chain.model.instructions;
        instructions.run(Energies {
            effect: self,
            chain,
            point,
        });
        0.0
    }

    fn drags(&self) -> bool {
        true
    }

    fn on_guide(&self, chain: &Chain, station: usize, _state: &State, _under: &Under<'_>) -> [f64; 2] {
        let (l, i) = chain.span_of(station);
        let taken = self.walls[l][0].lane(i - 1).take(&self.motions[l][0].lane(i - 1));
        [0, 1].map(|k| taken.film[k] + taken.inertia[k])
    }
}

impl<V: Vector> Motion<Eight<V>> {
    /// Writes all lanes to memory.
    #[inline(always)]
    fn store(self, to: &mut Motion<Lane>) {
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

/// Adds to the ends of span `l`, pipe and guide, what the force of both annuli at its stations, lane by lane, comes to there.
#[inline(always)]
fn on_ends<V: Vector>(chain: &Chain, l: usize, [inner, outer]: [[Eight<V>; 2]; 2], to: &mut [EndColumn; 2]) {
    let mut lanes = [Lane::default(); 4];
    for k in 0..2 {
        inner[k].store(&mut lanes[k]);
        outer[k].store(&mut lanes[2 + k]);
    }
    let [mut pipe, mut guide]: [[V; 2]; 2] = [load(&to[0]), load(&to[1])];
    for (lane, rows) in chain.model.kind(l).force.iter().skip(1).enumerate() {
        for k in 0..2 {
            let (inner, outer) = (lanes[k][lane], lanes[2 + k][lane]);
            pipe = plus_column(pipe, &rows[0][1 + k], V::splat(inner));
            guide = plus_column(guide, &rows[1][1 + k], V::splat(outer - inner));
        }
    }
    store(pipe, &mut to[0]);
    store(guide, &mut to[1]);
}

/// Motions and forces of the spans that moved.
struct Forces<'a> {
    effect: &'a mut MudWall,
    chain: &'a mut Chain,
    state: &'a State,
}

impl Kernel for Forces<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { effect, chain, state } = self;
        for l in 0..effect.walls.len() {
            if !chain.is_active(l) {
                continue;
            }
            let SpanMotion { d, v, a } = chain.span_motion::<V>(state, l);
            for (layer, to) in effect.motions[l].iter_mut().enumerate() {
                let eight = |of: &[[V; 2]; 2]| [Eight(of[layer][0]), Eight(of[layer][1])];
                let motion = Motion {
                    d: eight(&d),
                    v: eight(&v),
                    a: eight(&a),
                };
                motion.store(to);
            }
            let taken = effect.taken::<V>(l);
            let mut total = [taken[0].film, taken[1].film];
            for (total, taken) in total.iter_mut().zip(&taken) {
                for (sum, inertia) in total.iter_mut().zip(&taken.inertia) {
                    *sum = *sum + *inertia;
                }
            }
            let mut forces = *chain.inside(l);
            on_ends(chain, l, total, &mut forces);
            *chain.inside(l) = forces;
        }
    }
}

/// The derivative of the forces, station by station: most are near the centre, where there is none.
struct Tangents<'a, S> {
    effect: &'a MudWall,
    to: &'a mut Additions<S>,
    chain: &'a Chain,
    factors: TangentFactors,
}

impl<S: Precision> Kernel for Tangents<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            effect,
            to,
            chain,
            factors,
        } = self;
        let spans = effect.walls.iter().zip(&effect.motions).enumerate();
        for (l, (walls, motions)) in spans.filter(|(l, _)| chain.is_active(*l)) {
            // The station at the top of a span belongs to the span above, so that none counts twice.
            for i in 1..=chain.stations_below(l).len() {
                for (layer, (near, motion)) in walls.iter().zip(motions).enumerate() {
                    if let Some(tangent) = near.lane(i - 1).tangent(&motion.lane(i - 1), &factors) {
                        to.add_local::<V>(&chain.model, (l, i), layer == 0, [1, 2], &tangent);
                    }
                }
            }
        }
    }
}

/// Inertia, kinetic energy and damping.
struct Energies<'a> {
    effect: &'a MudWall,
    chain: &'a Chain,
    point: &'a mut LedgerPoint,
}

impl Kernel for Energies<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { effect, chain, point } = self;
        for l in 0..effect.walls.len() {
            let taken = effect.taken::<V>(l);
            let mut energy = Lane::default();
            (taken[0].energy + taken[1].energy).store(&mut energy);
            point.sums.kinetic += energy.iter().sum::<f64>();
            let inertia = [taken[0].inertia, taken[1].inertia];
            on_ends(chain, l, inertia, &mut point.spans[l].inertia);
            let mut film = [[0.0; 16]; 2];
            on_ends(chain, l, [taken[0].film, taken[1].film], &mut film);
            for (body, film) in film.iter().enumerate() {
                add_to_ends(&mut point.drag, l, body, film);
            }
        }
    }
}
