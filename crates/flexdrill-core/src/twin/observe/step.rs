//! What is taken from every step: contacts, loads, accelerations, samples of the whirl analysis and of the transfer.

use super::{Observer, gap_lateral};
use crate::chain::Effect;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::step::Stepper;
use crate::tool::{Body, Direction};
use crate::twin::snapshot::Applied;
use flexdrill_motion::{DriveState, StationSample, TransferSample};

impl Observer {
    pub(in crate::twin) fn after_step(
        &mut self,
        stepper: &mut Stepper,
        applied: &Applied,
        step: u64,
        dt: f64,
        iterations: u32,
    ) {
        self.last_iterations = iterations;
        // The quality counts first: it decides how far the levels of this step are trusted.
        if self.quality.push(dt, stepper.audit()) {
            self.update_trust();
        }
        let effects = stepper.effects();
        // Drag and power of a layer are summed with its contacts, as the transfer needs both.
        let mut rubbing = [Rubbing::default(); 2];
        for (layer, (body, statistics)) in [(Body::Pipe, &mut self.inner), (Body::Guide, &mut self.outer)]
            .into_iter()
            .enumerate()
        {
            effects.each_touched(body, &mut |station, touch| {
                statistics.touch(station, dt, touch.normal);
                self.shock.push(layer, station, dt, touch.normal);
                if layer == 0 {
                    self.chaotic_whirl.push(station, touch.dissipation * dt);
                }
                self.ageing.rub(layer, station, touch.friction_power * dt);
                rubbing[layer].drag -= touch.axial;
                rubbing[layer].power += touch.friction_power;
            });
            statistics.advance(dt);
        }
        // Nothing is judged while the drive stands or speeds up: transients would raise alarms.
        let (time, judged) = (step as f64 * dt, self.whirl.drive() == DriveState::Turning);
        self.shock.advance(time, dt, judged);
        for (joint, stop) in stepper.joints().stops().enumerate() {
            self.joint_load.push(joint, dt, stop.moment);
            self.ageing.stop(joint, dt, stop.moment);
        }
        self.joint_load.advance(time, dt, judged);
        // Chaos is judged by the power of collisions times the share of stations that move chaotically.
        let (taken, share) = (stepper.audit().contact_damping, self.whirl.chaotic_share());
        self.chaotic_whirl.advance(time, dt, taken, share, judged);

        // The transfer takes every step: a ripple of joints would otherwise be sampled.
        let mut sample = transfer_sample(stepper, applied, &rubbing);
        sample.rate_of_penetration = self.hole_deepens(stepper.bit_depth(), applied, dt);
        self.transfer.push(time, dt, &sample, stepper.audit(), judged);

        // The bit's motion comes from the chain, without the cost of a full state.
        let bottom = stepper.bottom_motion();
        let end = stepper.end_load();
        let of_bit = [end.torque, bottom.spin_rate, end.weight];
        self.bit.push(dt, of_bit);
        self.steering.push(dt, of_bit, sample.rate_of_penetration, stepper);
        self.tangential.push(dt, end.radius * bottom.spin_acceleration);
        self.axial.push(dt, bottom.axial_acceleration);
        self.lateral.push_square(dt, bottom.lateral_square);
        self.stick_slip
            .push(time, dt, bottom.spin_rate, applied.rotary_speed, judged);

        // Between two samples of the whirl analysis the contacts are
        // accumulated: impacts are shorter than its interval.
        let share = 1.0 / self.decimation as f64;
        for (sample, &(station, body)) in self.samples.iter_mut().zip(&self.watched) {
            if let Some(touch) = effects.touched(body, station) {
                sample.normal_force = sample.normal_force.max(touch.normal);
                sample.contact_share += share;
                sample.impulse += touch.normal * dt;
                sample.friction_work += touch.friction_power * dt;
            }
        }
        // The full state costs more than a step's statistics, so it is made for samples alone.
        if step.is_multiple_of(self.decimation) {
            stepper.refresh_view();
            let (model, state) = (stepper.model(), stepper.view());
            for (sample, &(station, body)) in self.samples.iter_mut().zip(&self.watched) {
                let lateral = gap_lateral(model, state, station, body);
                (sample.y, sample.z) = (lateral.x, lateral.y);
                sample.contact_share = sample.contact_share.min(1.0);
            }
            self.whirl.push(time, applied.rotary_speed, &self.samples);
            // Sums begin again after each sample.
            self.samples.fill(StationSample::default());
            let elapsed = self.decimation as f64 * dt;
            if let Some(watch) = &mut self.guide_preload {
                watch.push(time, elapsed, guide_moments(stepper, state), judged);
            }
            if let Some(watch) = &mut self.pressure_folding {
                // Without pressure nothing of the compression is the pressure's.
                let pushed = judged && stepper.pipe_is_pushed() == Some(true);
                watch.push(time, elapsed, state.pipe_axial.iter().map(|tension| -tension), pushed);
            }
            self.ageing
                .sample(self.decimation as f64 * dt, |joint| bending_below(model, state, joint));
        }
    }
}

impl Observer {
    /// Rate (m/s, at least 0) at which the hole deepens in a step of `dt` (s) that ends with the bit at `depth` (m, with a
    /// hoist). The bottom is as deep as the bit has come: a bit that is lifted makes no hole, nor does one that is lowered
    /// again until it is where it was, and one that chatters on the rock makes it in the parts of its path that lead
    /// deeper. Without a hoist the rate is given, and a bit without weight makes none.
    fn hole_deepens(&mut self, depth: Option<f64>, applied: &Applied, dt: f64) -> f64 {
        match (self.hole_depth, depth) {
            (Some(before), Some(depth)) => {
                let deepest = before.max(depth);
                self.hole_depth = Some(deepest);
                (deepest - before) / dt
            }
            _ if applied.weight_on_bit > 0.0 => applied.rate_of_penetration.max(0.0),
            _ => 0.0,
        }
    }
}

/// Sums of a layer's friction: drag (N) up the hole on the inner body, power (W).
#[derive(Debug, Clone, Copy, Default)]
struct Rubbing {
    drag: f64,
    power: f64,
}

/// What the step that was taken last says about transfer.
fn transfer_sample(stepper: &Stepper, applied: &Applied, [inner, outer]: &[Rubbing; 2]) -> TransferSample {
    let (above, end) = (stepper.load_above(), stepper.end_load());
    let carrier = above.and_then(|above| above.carrier);
    let drag_above = above.map_or([f64::NAN; 2], |above| above.drag);
    TransferSample {
        torque: [
            above.map_or(f64::NAN, |_| stepper.drive_torque()),
            stepper.torque_at_kickoff(),
            end.torque,
        ],
        weight: [
            carrier.map_or(f64::NAN, |carrier| carrier.weight),
            stepper.weight_at_kickoff().unwrap_or(f64::NAN),
            end.weight,
        ],
        speed: stepper.top_speed(),
        feed_power: outer.drag * stepper.advance_of_frame(),
        string_torque: drag_above[0],
        axial_drag: [inner.drag, outer.drag, carrier.map_or(f64::NAN, |_| drag_above[1])],
        hook_load: stepper.hook_load().unwrap_or(f64::NAN),
        depth_of_cut: end.depth_of_cut.unwrap_or(f64::NAN),
        rate_of_penetration: f64::NAN,
        friction_power: [inner.power, outer.power, stepper.joint_friction().iter().sum()],
        asked_speed: applied.rotary_speed,
        bit_speed: stepper.bottom_motion().spin_rate,
        drive_at_limit: above.map_or(f64::NAN, |above| f64::from(u8::from(above.drive_at_limit))),
        asked_weight: stepper.weight_of_hoist(applied.weight_set).unwrap_or(f64::NAN),
        arrives: stepper.arrives_round_the_arc(),
    }
}

/// Bending moment of each element of a preloaded guide (N m).
fn guide_moments<'a>(stepper: &'a Stepper, state: &'a State) -> impl Iterator<Item = f64> + 'a {
    let stations = &stepper.model().stations;
    stations.windows(2).enumerate().map(|(e, ends)| {
        let [above, below] = [ends[0].guide, ends[1].guide];
        let of = |node: usize, direction: Direction| state.q[node + direction as usize];
        let spin = 0.5 * (of(above, Direction::Psi) + of(below, Direction::Psi));
        let bent = [Direction::PhiY, Direction::PhiZ].map(|about| of(below, about) - of(above, about));
        stepper.effects().guide_moment(e, spin, bent)
    })
}

/// Bending moment (N m) in the middle of the link below a joint, from its curvature, about two transverse axes that
/// turn with the pipe: the load history of a material point.
fn bending_below(model: &Model, state: &State, joint: usize) -> [f64; 2] {
    let per_link = model.description.elements_per_link;
    let upper = model.joint_stations[joint] + (per_link - 1) / 2;
    let beam = &model.pipe[upper].beam;
    let (from, to) = (model.stations[upper].pipe_below, model.stations[upper + 1].pipe_above);
    let per_curvature = beam.section.bending / beam.length;
    let about = |direction: Direction| {
        let direction = direction as usize;
        per_curvature * (state.q[to + direction] - state.q[from + direction])
    };
    let (about_y, about_z) = (about(Direction::PhiY), about(Direction::PhiZ));
    let (sin, cos) = libm::sincos(state.q[from + Direction::Psi as usize]);
    [about_y * cos + about_z * sin, about_z * cos - about_y * sin]
}
