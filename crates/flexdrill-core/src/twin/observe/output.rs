//! The snapshot, made from the state and the statistics.

use super::{Observer, gap_lateral};
use crate::chain::Effect;
use crate::dynamics::state::{State, gap, inner_lateral, translation};
use crate::model::Model;
use crate::step::Stepper;
use crate::tool::{Body, Direction};
use crate::twin::fill::{fill_joints, fill_layer, fill_reactions, new_reactions};
use crate::twin::snapshot::{Bit, ContactLayer, Contacts, Joints, Shape, Snapshot};

impl Observer {
    /// A snapshot with all arrays at their size.
    pub(in crate::twin) fn new_snapshot(&self, model: &Model) -> Snapshot {
        // All vectors get their size here; filling a snapshot later allocates nothing.
        let joints = || vec![0.0; model.joints.len()];
        let stations = || vec![0.0; model.stations.len()];
        let layer = || ContactLayer {
            gap: stations(),
            normal: stations(),
            tangential: stations(),
            axial: stations(),
            normal_peak: stations(),
            normal_rms: stations(),
            shock: stations(),
        };
        // Depths, inclinations and limits never change and are written once.
        let mut out = Snapshot {
            joints: Joints {
                measured_depth: model.joint_stations.iter().map(|&s| model.stations[s].depth).collect(),
                inclination: model
                    .joint_stations
                    .iter()
                    .map(|&s| model.stations[s].inclination)
                    .collect(),
                bend_angle: joints(),
                bend_direction: joints(),
                limit_angle: model.joints.iter().map(|joint| joint.law.limit).collect(),
                stop_moment: joints(),
                lateral_y: joints(),
                lateral_z: joints(),
                spin_rate: joints(),
                axial_force: joints(),
                shear_force: joints(),
                torque: joints(),
            },
            contacts: Contacts {
                measured_depth: model.stations.iter().map(|s| s.depth).collect(),
                inclination: model.stations.iter().map(|s| s.inclination).collect(),
                state: vec![0; model.stations.len()],
                pipe_guide: layer(),
                guide_wall: layer(),
            },
            // The bore is fixed; pipe and guide are offsets in its frames, so that a viewer can exaggerate them.
            shape: Shape {
                bore: model.stations.iter().map(|s| s.position.into()).collect(),
                low_side: model
                    .stations
                    .iter()
                    .map(|s| s.frame.column(2).into_owned().into())
                    .collect(),
                pipe: vec![[0.0; 2]; model.stations.len()],
                guide: vec![[0.0; 2]; model.stations.len()],
            },
            reactions: new_reactions(model),
            // All other fields keep their defaults until the first fill.
            ..Snapshot::default()
        };
        // Reports of the analysis have their own arrays, which take their sizes in the same way.
        self.whirl.report(&mut out.whirl);
        self.ageing.write(&mut out.ageing);
        out
    }

    /// Fills a snapshot from the state and the statistics; the contacts' states are those of Table 2.
    pub(in crate::twin) fn fill(&self, stepper: &Stepper, state: &State, out: &mut Snapshot) {
        let (model, effects) = (stepper.model(), stepper.effects());
        // Joints first: their forces come from the elements and from effects.
        fill_joints(
            model,
            state,
            stepper.joints(),
            |joint| stepper.on_pins(joint),
            &mut out.joints,
        );
        let contacts = &mut out.contacts;
        let touched = |body: Body| move |station: usize| effects.touched(body, station);
        // Gaps are computed for all stations, also those without contact;
        // the statistics hold the forces between two snapshots.
        fill_layer(&mut contacts.pipe_guide, touched(Body::Pipe), &self.inner, |s| {
            let station = &model.stations[s];
            gap(inner_lateral(station, state), station.inner_clearance)
        });
        fill_layer(&mut contacts.guide_wall, touched(Body::Guide), &self.outer, |s| {
            gap(gap_lateral(model, state, s, Body::Guide), model.outer_clearance)
        });
        // Shock has its own window and is written over the layer's.
        self.shock.write(0, &mut contacts.pipe_guide.shock);
        self.shock.write(1, &mut contacts.guide_wall.shock);
        out.shock = self.shock.level();
        for (s, station) in model.stations.iter().enumerate() {
            // Bits of the state are those of Table 2: 1 for the inner contact, 2 for the outer.
            let [inner, outer] = [Body::Pipe, Body::Guide].map(|body| u8::from(effects.touched(body, s).is_some()));
            contacts.state[s] = inner + 2 * outer;
            let guide = translation(&state.q, station.guide);
            let pipe = station.pipe_to_station * translation(&state.q, station.pipe_above);
            out.shape.pipe[s] = [station.offset.x + pipe.y, station.offset.y + pipe.z];
            out.shape.guide[s] = [guide.y, guide.z];
        }
        // Torque and weight are the rock's, the speed that of the last node.
        let (bottom, end) = (&model.stations[model.last()], stepper.end_load());
        let [torque, rotary_speed, weight_on_bit] = [
            end.torque,
            state.v[bottom.pipe_above + Direction::Psi as usize],
            end.weight,
        ];
        // Before the first interval has a mean, the present values stand for it.
        let means = self.bit.value().unwrap_or([torque, rotary_speed, weight_on_bit]);
        out.bit = Bit {
            torque,
            rotary_speed,
            weight_on_bit,
            mean_torque: means[0],
            mean_rotary_speed: means[1],
            mean_weight_on_bit: means[2],
            stick_slip_index: self.stick_slip.index(),
            tangential_acceleration: self.tangential.value(),
            axial_acceleration: self.axial.value(),
            lateral_acceleration: self.lateral.value(),
            lateral_acceleration_peak: self.lateral.peak(),
            lateral_impulse: self.lateral.impulse(),
            stick_slip: self.stick_slip.severity(),
        };
        out.steering = self.steering.value([torque, rotary_speed, weight_on_bit], stepper);
        fill_reactions(stepper, &mut out.reactions);
        out.transfer = *self.transfer.summary();
        self.whirl.report(&mut out.whirl);
        out.warning = self.whirl.level();
        // Hazards last, because they rest on everything above.
        out.hazards = self.hazards(model, out.time);
        self.ageing.write(&mut out.ageing);
        out.quality = self.quality();
    }
}
