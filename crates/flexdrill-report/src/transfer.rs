//! Torque, weight and power from the surface to the bit over time.

use crate::history::History;
use flexdrill_messages::Transfer;

/// A quantity with its name, its value in a message, and its history.
#[derive(Debug)]
pub(crate) struct Quantity {
    pub name: &'static str,
    of: fn(&Transfer) -> f64,
    pub history: History,
}

/// A name, and how its value is read from a message.
type Read = (&'static str, fn(&Transfer) -> f64);

/// Quantities of one unit, in the order of the table.
#[derive(Debug)]
pub(crate) struct Group {
    pub quantities: Vec<Quantity>,
}

impl Group {
    fn new(quantities: &[Read]) -> Self {
        let quantity = |&(name, of)| Quantity {
            name,
            of,
            history: History::default(),
        };
        Self {
            quantities: quantities.iter().map(quantity).collect(),
        }
    }

    fn push(&mut self, time: f64, message: &Transfer) {
        for quantity in &mut self.quantities {
            // A figure that the tool does not have is not a number; the history leaves it out.
            quantity.history.push(time, (quantity.of)(message));
        }
    }
}

/// Everything that `twin/transfer` says, over time.
#[derive(Debug)]
pub(crate) struct TransferHistory {
    /// Torques from the surface to the bit (N m).
    pub torque: Group,
    /// Torques that friction takes (N m).
    pub friction: Group,
    /// Weights from the surface to the bit and the hook load (N).
    pub weight: Group,
    /// Axial drags (N).
    pub drag: Group,
    /// m per turn.
    pub depth_of_cut: History,
    /// m/s.
    pub rate_of_penetration: History,
    /// Share of the time, 0 to 1.
    pub drive_at_limit: History,
    /// Powers that are put in (W).
    pub put_in: Group,
    /// Powers that are taken (W).
    pub taken: Group,
    /// Time that a mean covers (s).
    pub window: f64,
}

impl Default for TransferHistory {
    fn default() -> Self {
        // Within a group the order is from the surface to the bit, and the page shows it so.
        Self {
            torque: Group::new(&[
                ("torque at the surface", |m| m.surface_torque),
                ("torque at the kick-off", |m| m.kickoff_torque),
                ("torque at the bit", |m| m.bit_torque),
            ]),
            friction: Group::new(&[
                ("friction of the string", |m| m.string_friction_torque),
                ("friction of pipe in guide", |m| m.pipe_guide_friction_torque),
                ("friction in the joints", |m| m.joint_friction_torque),
                ("friction of the wall on the guide", |m| m.guide_wall_friction_torque),
            ]),
            weight: Group::new(&[
                ("hook load", |m| m.hook_load),
                ("weight at the surface", |m| m.surface_weight),
                ("weight at the kick-off, on the guide", |m| m.kickoff_weight),
                ("weight at the bit", |m| m.bit_weight),
            ]),
            drag: Group::new(&[
                ("drag of the string", |m| m.string_axial_drag),
                ("drag of the guide on the pipe", |m| m.pipe_guide_axial_drag),
                ("drag of the wall on the guide", |m| m.guide_wall_axial_drag),
            ]),
            depth_of_cut: History::default(),
            rate_of_penetration: History::default(),
            drive_at_limit: History::default(),
            // Shares of both groups refer to the power that is put in.
            put_in: Group::new(&[
                ("top drive", |m| m.drive_power),
                ("hoist", |m| m.hoist_power),
                ("weight on bit", |m| m.weight_on_bit_power),
                ("gravity", |m| m.gravity_power),
                ("advance against the wall", |m| m.feed_power),
                ("pressure", |m| m.pressure_power),
                ("loads", |m| m.load_power),
            ]),
            // The rock comes first, then what friction and damping dissipate; the scheme's own damping is last.
            taken: Group::new(&[
                ("rock", |m| m.bit_power),
                ("friction of pipe in guide", |m| m.pipe_guide_friction_power),
                ("friction of guide on wall", |m| m.guide_wall_friction_power),
                ("friction in the joints", |m| m.joint_friction_power),
                ("friction and mud along the string", |m| m.string_power),
                ("collisions", |m| m.contact_damping_power),
                ("damping of the steel", |m| m.rayleigh_damping_power),
                ("mud around the pipes", |m| m.mud_power),
                ("time integration", |m| m.numerical_damping_power),
            ]),
            window: f64::NAN,
        }
    }
}

impl TransferHistory {
    pub(crate) fn push(&mut self, time: f64, message: &Transfer) {
        let groups = [
            &mut self.torque,
            &mut self.friction,
            &mut self.weight,
            &mut self.drag,
            &mut self.put_in,
            &mut self.taken,
        ];
        groups.into_iter().for_each(|group| group.push(time, message));
        self.depth_of_cut.push(time, message.depth_of_cut);
        self.rate_of_penetration.push(time, message.rate_of_penetration);
        self.drive_at_limit.push(time, message.drive_at_limit);
        self.window = self.window.max(message.duration);
    }

    /// Mean torque at the bit over that at the uppermost place that the tool has; `None` without torque. The mean of the
    /// messages' quotients would count a run-up without weight as much as drilling.
    pub(crate) fn torque_efficiency(&self) -> Option<f64> {
        let mut means = self
            .torque
            .quantities
            .iter()
            .filter_map(|quantity| quantity.history.range());
        let top = means.next()?.mean;
        let bit = means.next_back()?.mean;
        (top.abs() >= 1.0).then(|| bit / top)
    }

    /// Whether anything is known.
    pub(crate) fn is_known(&self) -> bool {
        self.torque
            .quantities
            .iter()
            .any(|quantity| quantity.history.range().is_some())
    }
}
