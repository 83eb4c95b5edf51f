//! What acts on the tool beyond beams and joints: a file each, with law, switch, force, tangent, energy and history.
//!
//! The list below is the only place that names them all. They act in its order, so that sums have one order too; an
//! effect may read what an earlier one has written ([`Along`](crate::chain::Along)). A new effect
//! is a file that implements [`Effect`], with a constructor `of` that gives `None` for a tool without it, and a line here. One
//! with a history has a line in the second list, too.

pub(crate) mod bit;
pub(crate) mod bodies;
pub(crate) mod contact;
pub(crate) mod mud;
pub(crate) mod mud_wall;
pub(crate) mod preload;
pub(crate) mod pressure;
pub(crate) mod shortening;
pub(crate) mod slots;
pub(crate) mod string;
#[cfg(test)]
mod tests;

#[cfg(feature = "checkpoints")]
use std::borrow::Cow;

use flexdrill_base::energies::Energies;
use nalgebra::Vector3;
#[cfg(feature = "checkpoints")]
use serde::{Deserialize, Serialize};

use crate::chain::{Acting, Additions, Asked, Chain, Effect, EndLoad, FromAbove, Precision, Touched, Under};
use crate::dynamics::carried::Carried;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::{LEDGER_PLACES, LedgerPoint, StepWork};
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::{Deflection, State};
use crate::elements::factors::TangentFactors;
use crate::model::Model;
use crate::tool::Body;

/// Makes [`Effects`] of a list of names and types.
macro_rules! effects {
    ($($(#[$attribute:meta])* $name:ident: $effect:ty,)+) => {
        /// All effects that the tool has, with what they found at the last residual.
        #[derive(Clone)]
        pub(crate) struct Effects {
            $($(#[$attribute])* pub(crate) $name: Option<$effect>,)+
        }

        impl Effects {
            /// Those of `model`, on the nodes of `chain`.
            pub(crate) fn of(model: &Model, chain: &Chain) -> Self {
                Self {
                    $($(#[$attribute])* $name: <$effect>::of(model, chain),)+
                }
            }
        }

        impl Effect for Effects {
            fn prepare(&mut self, h: f64) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.prepare(h);
                })+
            }

            fn hold(&mut self) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.hold();
                })+
            }

            fn release(&mut self, state: &State, conditions: &mut Conditions) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.release(state, conditions);
                })+
            }

            fn resume(&mut self, state: &State, conditions: &mut Conditions) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.resume(state, conditions);
                })+
            }

            fn lead(&mut self, asked: &Asked, conditions: &mut Conditions) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.lead(asked, conditions);
                })+
            }

            fn settle(&self, state: &mut State) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.settle(state);
                })+
            }

            fn begin(&mut self, from: &State, step: f64) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.begin(from, step);
                })+
            }

            fn force(&mut self, chain: &mut Chain, state: &mut State, under: &Under<'_>) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.force(chain, state, under);
                })+
            }

            fn at_stations<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, at: &Iteration<'_>) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.at_stations(to, chain, at);
                })+
            }

            fn tangent<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, state: &State, at: &Iteration<'_>) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.tangent(to, chain, state, at);
                })+
            }

            fn at_nodes(&self, residual: &mut [f64], state: &State, under: &Under<'_>, wanted: &impl Fn(usize) -> bool) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.at_nodes(residual, state, under, wanted);
                })+
            }

            fn applied(&self, residual: &mut [f64], wanted: &impl Fn(usize) -> bool) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.applied(residual, wanted);
                })+
            }

            fn at_ends(&self, factors: TangentFactors, add: &mut impl FnMut(usize, usize, f64)) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.at_ends(factors, add);
                })+
            }

            fn energy(&self, chain: &Chain, point: &mut LedgerPoint, state: &State, under: &Under<'_>) -> f64 {
                let mut stored = 0.0;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    stored += effect.energy(chain, point, state, under);
                })+
                stored
            }

            fn friction(&self, chain: &Chain, point: &mut LedgerPoint, under: &Under<'_>) -> f64 {
                let mut stored = 0.0;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    stored += effect.friction(chain, point, under);
                })+
                stored
            }

            fn deflect(&self, chain: &Chain, to: &mut [Deflection]) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.deflect(chain, to);
                })+
            }

            fn leave(&self, to: &mut State) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.leave(to);
                })+
            }

            fn accept(&mut self, state: &State) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.accept(state);
                })+
            }

            fn close(&self, point: &mut LedgerPoint) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.close(point);
                })+
            }

            fn keep(&mut self) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.keep();
                })+
            }

            fn retreat(&mut self) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.retreat();
                })+
            }

            fn unwind(&mut self, turns: f64) {
                $($(#[$attribute])* if let Some(effect) = &mut self.$name {
                    effect.unwind(turns);
                })+
            }

            fn carry(&self, carried: &mut Carried) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.carry(carried);
                })+
            }

            fn work(&self, chain: &Chain, step: &StepWork<'_>, ledger: &mut Energies) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.work(chain, step, ledger);
                })+
            }

            fn drags(&self) -> bool {
                let mut any = false;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    any |= effect.drags();
                })+
                any
            }

            fn has_tension(&self) -> bool {
                let mut any = false;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    any |= effect.has_tension();
                })+
                any
            }

            fn tension_beyond(&self, l: usize) -> f64 {
                let mut sum = 0.0;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    sum += effect.tension_beyond(l);
                })+
                sum
            }

            fn on_guide(&self, chain: &Chain, station: usize, state: &State, under: &Under<'_>) -> [f64; 2] {
                let mut sum = [0.0; 2];
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    let force = effect.on_guide(chain, station, state, under);
                    sum = [sum[0] + force[0], sum[1] + force[1]];
                })+
                sum
            }

            fn guide_moment(&self, e: usize, spin: f64, bent: [f64; 2]) -> f64 {
                let mut sum = 0.0;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    sum += effect.guide_moment(e, spin, bent);
                })+
                sum
            }

            fn bends_guide(&self) -> bool {
                let mut any = false;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    any |= effect.bends_guide();
                })+
                any
            }

            fn weight(&self) -> Vector3<f64> {
                let mut sum = Vector3::zeros();
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    sum += effect.weight();
                })+
                sum
            }

            fn touched(&self, body: Body, station: usize) -> Option<Touched> {
                let mut found = None;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    found = found.or(effect.touched(body, station));
                })+
                found
            }

            fn each_touched(&self, body: Body, visit: &mut impl FnMut(usize, &Touched)) {
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    effect.each_touched(body, visit);
                })+
            }

            fn end_load(&self) -> Option<EndLoad> {
                let mut found = None;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    found = found.or(effect.end_load());
                })+
                found
            }

            fn load_above(&self, state: &State) -> Option<FromAbove> {
                let mut found = None;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    found = found.or(effect.load_above(state));
                })+
                found
            }

            fn on_pins(&self, joint: usize, carried: &Carried) -> f64 {
                let mut sum = 0.0;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    sum += effect.on_pins(joint, carried);
                })+
                sum
            }

            fn pulls_guide(&self, carried: &Carried) -> f64 {
                let mut sum = 0.0;
                $($(#[$attribute])* if let Some(effect) = &self.$name {
                    sum += effect.pulls_guide(carried);
                })+
                sum
            }

            fn pushes_pipe(&self, carried: &Carried) -> Option<bool> {
                let mut any = None;
                $($(#[$attribute])* if let Some(pushes) = self.$name.as_ref().and_then(|effect| effect.pushes_pipe(carried)) {
                    any = Some(pushes || any == Some(true));
                })+
                any
            }
        }
    };
}

effects! {
    contact: contact::Contact,
    bodies: bodies::Bodies,
    mud: mud::Mud,
    preload: preload::Preloaded,
    mud_wall: mud_wall::MudWall,
    pressure: pressure::Pressurised,
    shortening: shortening::Shortened,
    slots: slots::SlottedGuide,
    #[cfg(test)]
    springs: tests::spring::Springs,
    bit: bit::Bit,
    string: string::DrillString,
}

/// Makes [`Histories`] of the effects that have one, in a list of names and types.
macro_rules! histories {
    ($($name:ident: $history:ty,)+) => {
        /// What effects keep of the motion so far, by name: all that a run needs of them to continue.
        #[cfg(feature = "checkpoints")]
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub(crate) struct Histories<'a> {
            $($name: Option<Cow<'a, $history>>,)+
        }

        #[cfg(feature = "checkpoints")]
        impl Effects {
            /// Their histories, to be saved.
            pub(crate) fn histories(&self) -> Histories<'_> {
                Histories {
                    $($name: self.$name.as_ref().and_then(|effect| effect.history()).map(Cow::Borrowed),)+
                }
            }

            /// Whether saved histories are those of the same effects.
            pub(crate) fn fit(&self, saved: &Histories<'_>) -> bool {
                true $(&& match (&self.$name, &saved.$name) {
                    (Some(effect), Some(saved)) => effect.fits(saved),
                    (None, None) => true,
                    _ => false,
                })+
            }

            /// Continues with saved histories that fit.
            pub(crate) fn restore(&mut self, saved: &Histories<'_>) {
                $(if let (Some(effect), Some(saved)) = (&mut self.$name, &saved.$name) {
                    effect.restore(saved);
                })+
            }
        }
    };
}

histories! {
    bit: bit::BitState,
    string: string::StringState,
}

/// First of the places that an effect has in [`Sums::of_effects`](crate::dynamics::energy::Sums::of_effects).
mod places {
    /// One.
    pub(super) const PRESSURE: usize = 0;
    /// Two.
    pub(super) const BIT: usize = 1;
    /// Three.
    pub(super) const STRING: usize = 3;
    /// How many are taken.
    pub(super) const ALL: usize = 6;
}
const _: () = assert!(places::ALL == LEDGER_PLACES, "a place for each number of an effect");

/// What effects add to the chain of `model` that is built.
pub(crate) fn acting(model: &Model) -> Acting {
    Acting {
        every_station: slots::is_on(model),
        at_nodes: |model| bodies::at_nodes(model).collect(),
        stiffness: contact::stiffness,
        linear: |at, parts| {
            mud::linear(at, parts);
            preload::linear(at, parts);
        },
    }
}
