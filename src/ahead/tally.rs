//! The figures of a member: sums and maxima over its looks.

use super::member::Figure;
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::rad_per_s_to_rpm;
use flexdrill_motion::{BIT, KICK_OFF, SURFACE};

/// Damage of the joint that has aged most.
pub(super) fn damage(snapshot: &Snapshot) -> f64 {
    let ageing = &snapshot.ageing;
    let damages = ageing.stop_damage.iter().zip(&ageing.bending_damage);
    damages.map(|(stop, bending)| stop.max(*bending)).fold(0.0, f64::max)
}

/// Sums and maxima over the looks of a member.
#[derive(Default)]
pub(super) struct Tally {
    ripple: Mean,
    cycles: Mean,
    torque: Mean,
    weight: Mean,
    forces: [f64; 2],
    stop: f64,
}

#[derive(Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        if value.is_finite() {
            self.sum += value;
            self.count += 1.0;
        }
    }

    fn value(&self) -> f64 {
        self.sum / self.count
    }
}

impl Tally {
    pub fn add(&mut self, snapshot: &Snapshot) {
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        self.ripple.add(snapshot.bit.stick_slip_index);
        let turns_per_hour = 60.0 * rad_per_s_to_rpm(snapshot.applied.rotary_speed).abs();
        self.cycles.add(most(&snapshot.whirl.bending_cycles) * turns_per_hour);
        let layers = [&snapshot.contacts.pipe_guide, &snapshot.contacts.guide_wall];
        for (force, layer) in self.forces.iter_mut().zip(layers) {
            *force = force.max(most(&layer.normal_peak));
        }
        self.stop = self.stop.max(most(&snapshot.joints.stop_moment));
        let transfer = &snapshot.transfer;
        self.torque.add(transfer.torque_efficiency);
        let weight = &transfer.weight.mean;
        let above = if weight[SURFACE].is_finite() {
            weight[SURFACE]
        } else {
            weight[KICK_OFF]
        };
        if above > 0.0 {
            self.weight.add(weight[BIT] / above);
        }
    }

    /// With the damage per hour.
    pub fn figures(&self, damage: f64) -> [f64; Figure::ALL.len()] {
        Figure::ALL.map(|figure| match figure {
            Figure::Ripple => self.ripple.value(),
            Figure::PipeGuideForce => self.forces[0],
            Figure::GuideWallForce => self.forces[1],
            Figure::StopMoment => self.stop,
            Figure::BendingCycles => self.cycles.value(),
            Figure::Damage => damage,
            Figure::TorqueTransfer => self.torque.value(),
            Figure::WeightTransfer => self.weight.value(),
        })
    }
}
