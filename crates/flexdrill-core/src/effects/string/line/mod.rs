//! The string's pieces, ends and frictions, step by step.

#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::history::{History, Mark};
use super::hoist::HoistState;
use super::top_drive::DriveState;
use crate::tool::description::{Piece, ROWS_PER_STEP, StringDescription, Wave};
use crate::tool::section::SectionProperties;

/// Time (s) within which what takes energy from a wave follows the string. The loss of a wave of angular frequency w is
/// (w t)^2 / (1 + (w t)^2) of its limit: 0.99 for the first mode of 1000 m of drill pipe, 0.9 for that of 3000 m.
pub const FOLLOWS_WITHIN: f64 = 2.0;

/// Waves per piece: torsional down and up, axial down and up.
const WAVES: usize = 4;

impl Piece {
    /// Longest time of travel (s).
    fn longest_delay(&self) -> f64 {
        self.torsion.delay.max(self.axial.delay)
    }

    /// A piece of `length` (m) of a tube. Impedances are J sqrt(G rho) and A sqrt(E rho), delays L sqrt(rho / G) and L
    /// sqrt(rho / E).
    pub fn of(section: &SectionProperties, length: f64) -> Self {
        let wave = |stiffness: f64, inertia: f64| Wave {
            impedance: (stiffness * inertia).sqrt(),
            delay: length * (inertia / stiffness).sqrt(),
            drag: 0.0,
        };
        Self {
            length,
            torsion: wave(section.torsion, section.spin_inertia),
            axial: wave(section.axial, section.mass),
            friction: None,
        }
    }

    /// The same with a loss at its lower end that lets the part e^-loss of a wave pass: 2 z / (2 z + drag). The dashpot
    /// stands on a body that it takes along, so that a steady rotation or advance takes nothing, and a static load does not
    /// creep: waves alone are attenuated, in full at frequencies well above half a radian per second.
    #[must_use]
    pub fn with_loss(mut self, loss: f64) -> Self {
        for wave in [&mut self.torsion, &mut self.axial] {
            wave.drag = 2.0 * wave.impedance * (libm::exp(loss) - 1.0);
        }
        self
    }
}

impl StringDescription {
    /// Static stiffness along the hole (N/m): a piece's is z / tau.
    pub fn axial_stiffness(&self) -> f64 {
        1.0 / self
            .pieces
            .iter()
            .map(|piece| piece.axial.delay / piece.axial.impedance)
            .sum::<f64>()
    }

    /// Static stiffness in torsion (N m/rad).
    pub fn torsional_stiffness(&self) -> f64 {
        1.0 / self
            .pieces
            .iter()
            .map(|piece| piece.torsion.delay / piece.torsion.impedance)
            .sum::<f64>()
    }

    /// Shortest time of travel through a piece (s), of the waves that there are.
    pub fn shortest_delay(&self) -> f64 {
        let of = |piece: &Piece| {
            let axial = self.hoist.map_or(f64::INFINITY, |_| piece.axial.delay);
            piece.torsion.delay.min(axial)
        };
        self.pieces.iter().map(of).fold(f64::INFINITY, f64::min)
    }
}

/// What the string does at one instant: all that a run needs to continue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StringState {
    /// Per piece.
    histories: Vec<History>,
    ends: Ends,
    /// Whether each friction is static.
    stuck: Vec<bool>,
    /// Speeds of what each loss stands on, around (rad/s) and along (m/s).
    following: Vec<[f64; 2]>,
}

/// Drive, hoist and what has been lost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Ends {
    drive: DriveState,
    hoist: HoistState,
    /// Energy lost to friction on the wall (J), and by the attenuation of waves (J).
    friction: f64,
    attenuation: f64,
    /// Work of the hoist's block (J).
    hoist_work: f64,
    /// Power lost at this instant (W), to friction and by attenuation.
    powers: [f64; 2],
    /// Torque (N m) and force (N) of all frictions at this instant.
    drag: [f64; 2],
    /// The tool's top in the frame of its displacements: how far down it is (m), and its speed (m/s).
    top: [f64; 2],
    /// Axial force on the tool's top (N), compressing.
    force_on_tool: f64,
}

/// A step of the string, before the tool's part of it is known.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StringStep {
    /// Torque on the tool is z (2 f - w): the impedance z (N m s) and the arriving wave f (rad/s).
    pub torsion: [f64; 2],
    /// Force on the tool is z (2 f - u'): the impedance (N s/m) and the arriving wave (m/s); `None` without a hoist.
    pub axial: Option<[f64; 2]>,
    /// Angle by which the drive turns in the step (rad).
    pub drive_turns: f64,
    /// Torque of the drive's motor (N m).
    pub drive_torque: f64,
    /// Rate of advance (m/s), and distance advanced so far (m).
    pub advance: f64,
    /// Distance advanced so far (m).
    pub depth: f64,
}

/// The string with its state, and room for a step.
#[derive(Debug, Clone)]
pub struct StringLine {
    description: StringDescription,
    state: StringState,
    /// Of the step that is tried: the row without the wave that comes up from the tool, ends, frictions.
    row: Vec<f64>,
    ends: Ends,
    stuck: Vec<bool>,
    following: Vec<[f64; 2]>,
    time: f64,
    /// The state at the start of the step.
    marks: Vec<Mark>,
    marked: Ends,
    marked_stuck: Vec<bool>,
    marked_following: Vec<[f64; 2]>,
}

/// Impedance and arriving wave of an axial end whose speed is counted in a frame that advances: z (2 f - (v + V)) = z (2 (f -
/// V / 2) - v). The string itself moves in the frame of the hole, so that its inertia takes part in every acceleration.
fn in_frame(impedance: f64, arriving: f64, advance: f64) -> [f64; 2] {
    [impedance, arriving - 0.5 * advance]
}

/// Places in a row.
fn down(piece: usize, kind: usize) -> usize {
    WAVES * piece + 2 * kind
}

fn up(piece: usize, kind: usize) -> usize {
    WAVES * piece + 2 * kind + 1
}

impl StringLine {
    /// The string at rest, for steps of size `h` (s).
    pub fn new(description: &StringDescription, h: f64) -> Self {
        let pieces = description.pieces.len();
        let of = |piece: &Piece| History::new(WAVES, piece.longest_delay(), h / ROWS_PER_STEP);
        let histories: Vec<History> = description.pieces.iter().map(of).collect();
        Self {
            marks: histories.iter().map(History::new_mark).collect(),
            state: StringState {
                histories,
                ends: Ends::default(),
                stuck: vec![true; pieces],
                following: vec![[0.0; 2]; pieces],
            },
            row: vec![0.0; WAVES * pieces],
            ends: Ends::default(),
            stuck: vec![true; pieces],
            following: vec![[0.0; 2]; pieces],
            time: 0.0,
            marked: Ends::default(),
            marked_stuck: vec![true; pieces],
            marked_following: vec![[0.0; 2]; pieces],
            description: description.clone(),
        }
    }

    /// The string as built.
    #[cfg(test)]
    pub fn description(&self) -> &StringDescription {
        &self.description
    }

    /// Turns steadily at `speed` (rad/s) from `time` (s) on, with the `torque` (N m) and the `force` (N, compressing) that
    /// the tool's top takes.
    pub fn begin(&mut self, time: f64, speed: f64, torque: f64, force: f64) {
        for (k, piece) in self.description.pieces.iter().enumerate() {
            for (kind, wave, velocity, load) in [(0, piece.torsion, speed, torque), (1, piece.axial, 0.0, force)] {
                let difference = if wave.impedance > 0.0 {
                    load / wave.impedance
                } else {
                    0.0
                };
                self.row[down(k, kind)] = 0.5 * (velocity + difference);
                self.row[up(k, kind)] = 0.5 * (velocity - difference);
            }
        }
        let pieces = self.description.pieces.iter().zip(self.row.chunks(WAVES));
        for (history, (piece, waves)) in self.state.histories.iter_mut().zip(pieces) {
            history.begin(time, piece.longest_delay(), waves);
        }
        let impedance = self.description.pieces[0].axial.impedance;
        self.state.ends = Ends {
            drive: self.description.drive.steady(speed, torque),
            hoist: (self.description.hoist).map_or(HoistState::default(), |hoist| hoist.at_rest(force, impedance)),
            force_on_tool: force,
            ..Ends::default()
        };
        self.state.stuck.fill(speed == 0.0);
        self.state.following.fill([speed, 0.0]);
    }

    /// The step of size `h` (s) to `time` (s), in which the drive is asked for `speed` (rad/s) and the hoist for `weight` (N)
    /// or, by its feed, `rate` (m/s). It counts once [`StringLine::accept`] is called.
    pub fn step(&mut self, time: f64, h: f64, speed: f64, weight: f64, rate: f64) -> StringStep {
        let Self {
            description,
            state,
            row,
            ends,
            stuck,
            following,
            time: at,
            ..
        } = self;
        // Everything is computed from the accepted state, so that a part of the step may be tried again.
        *at = time;
        stuck.copy_from_slice(&state.stuck);
        *ends = state.ends;
        ends.powers = [0.0; 2];
        ends.drag = [0.0; 2];
        let pieces = &description.pieces;
        // Waves that leave the pieces now. Each is kept in the row in the place of the wave that replaces it below: one
        // that leaves a piece downwards in that of the next one upwards, and the reverse.
        // Without a hoist the axial wave is left out: the weight is an input.
        let kinds = if description.hoist.is_some() { 2 } else { 1 };
        for (k, (piece, history)) in pieces.iter().zip(&state.histories).enumerate() {
            for (kind, wave) in [piece.torsion, piece.axial].into_iter().enumerate().take(kinds) {
                let reading = history.at(time - wave.delay);
                let (f, g) = (
                    history.wave(&reading, down(0, kind)),
                    history.wave(&reading, up(0, kind)),
                );
                row[up(k, kind)] = f;
                row[down(k, kind)] = g;
            }
        }
        // The drive turns the top of the first piece: it takes the wave that rises and sends one down.
        let torsion = pieces[0].torsion.impedance;
        let rising = row[down(0, 0)];
        ends.drive = description.drive.step(&state.ends.drive, h, speed, rising, torsion);
        row[down(0, 0)] = ends.drive.speed - rising;
        // The hoist does the same along the string.
        if let Some(hoist) = description.hoist {
            let (stiffness, impedance) = (description.axial_stiffness(), pieces[0].axial.impedance);
            let mut next = hoist.step(&state.ends.hoist, h, stiffness, [weight, rate], state.ends.top);
            row[down(0, 1)] = hoist.push(&state.ends.hoist, &mut next, h, row[down(0, 1)], impedance);
            ends.hoist = next;
            ends.hoist_work += hoist.work(&state.ends.hoist, &ends.hoist, h);
        }
        // At each joint of two pieces both waves arrive, and the joint moves as the impedances share them.
        for k in 0..pieces.len() - 1 {
            let (above, below) = (&pieces[k], &pieces[k + 1]);
            let sums = [
                above.torsion.impedance + below.torsion.impedance + above.torsion.drag,
                above.axial.impedance + below.axial.impedance + above.axial.drag,
            ];
            let held = |kind: usize, z: [f64; 2]| 2.0 * (z[0] * row[up(k, kind)] + z[1] * row[down(k + 1, kind)]);
            let mut held = [
                held(0, [above.torsion.impedance, below.torsion.impedance]),
                held(1, [above.axial.impedance, below.axial.impedance]),
            ];
            // The loss acts on the difference to a body that follows, so that a steady motion loses nothing.
            let (drags, taken_along) = ([above.torsion.drag, above.axial.drag], state.following[k]);
            for kind in 0..2 {
                held[kind] += drags[kind] * taken_along[kind];
            }
            // Without a hoist nothing moves along the string.
            if kinds == 1 {
                held[1] = 0.0;
            }
            // Friction may hold the joint: then its speed is zero in both directions.
            let motion = match above.friction {
                Some(friction) => {
                    let motion = friction.motion(held, sums, stuck[k]);
                    stuck[k] = motion.is_static;
                    motion
                }
                None => super::friction::Motion {
                    speeds: [held[0] / sums[0], held[1] / sums[1]],
                    ..super::friction::Motion::default()
                },
            };
            for kind in 0..2 {
                // What the loss stands on follows by the implicit rule of Euler.
                let passing = motion.speeds[kind] - taken_along[kind];
                following[k][kind] = taken_along[kind] + passing * h / (FOLLOWS_WITHIN + h);
                ends.powers[0] += motion.friction[kind] * motion.speeds[kind];
                ends.powers[1] += drags[kind] * passing * passing;
                ends.drag[kind] += motion.friction[kind];
            }
            for (kind, speed) in motion.speeds.into_iter().enumerate().take(kinds) {
                // What leaves here downwards is the speed less what comes up, and the other way round.
                let (f, g) = (row[up(k, kind)], row[down(k + 1, kind)]);
                row[up(k, kind)] = speed - f;
                row[down(k + 1, kind)] = speed - g;
            }
        }
        let last = pieces.len() - 1;
        // Works by the trapezoid rule of powers, like all of the audit's.
        ends.friction += 0.5 * h * (state.ends.powers[0] + ends.powers[0]);
        ends.attenuation += 0.5 * h * (state.ends.powers[1] + ends.powers[1]);
        // What arrives at the tool: an impedance and a wave, to which the tool's end adds its own motion.
        StringStep {
            torsion: [pieces[last].torsion.impedance, row[up(last, 0)]],
            axial: description
                .hoist
                .map(|_| in_frame(pieces[last].axial.impedance, row[up(last, 1)], ends.hoist.advance)),
            drive_turns: 0.5 * h * (state.ends.drive.speed + ends.drive.speed),
            drive_torque: ends.drive.torque,
            advance: ends.hoist.advance,
            depth: ends.hoist.depth,
        }
    }

    /// Takes the step: at its end the tool's top turns at `speed` (rad/s), and its displacement (m) and speed (m/s) along the
    /// hole are `top` in the frame that advances.
    pub fn accept(&mut self, speed: f64, top: [f64; 2]) {
        let last = self.description.pieces.len() - 1;
        let velocity = top[1] + self.ends.hoist.advance;
        let axial = self
            .description
            .hoist
            .map(|_| self.description.pieces[last].axial.impedance);
        self.ends.top = top;
        self.ends.force_on_tool = axial.map_or(0.0, |impedance| impedance * (2.0 * self.row[up(last, 1)] - velocity));
        for (kind, motion) in [speed, velocity].into_iter().enumerate() {
            let place = up(last, kind);
            self.row[place] = motion - self.row[place];
        }
        for (history, waves) in self.state.histories.iter_mut().zip(self.row.chunks(WAVES)) {
            history.record(self.time, waves);
        }
        self.state.ends = self.ends;
        self.state.stuck.copy_from_slice(&self.stuck);
        self.state.following.copy_from_slice(&self.following);
    }

    /// The string's end as it is now, while the tool's top moves with these speeds (rad/s; m/s in the frame that advances).
    pub fn present(&self, speed: f64, velocity: f64) -> StringStep {
        let pieces = &self.description.pieces;
        let last = pieces.len() - 1;
        let row = self.state.histories[last].last();
        let ends = &self.state.ends;
        StringStep {
            torsion: [pieces[last].torsion.impedance, speed - row[up(0, 0)]],
            axial: (self.description.hoist).map(|_| {
                let arriving = velocity + ends.hoist.advance - row[up(0, 1)];
                in_frame(pieces[last].axial.impedance, arriving, ends.hoist.advance)
            }),
            drive_turns: 0.0,
            drive_torque: ends.drive.torque,
            advance: ends.hoist.advance,
            depth: ends.hoist.depth,
        }
    }

    /// Keeps the present state for [`StringLine::retreat`].
    pub fn keep(&mut self) {
        for (history, mark) in self.state.histories.iter().zip(&mut self.marks) {
            history.mark(mark);
        }
        self.marked = self.state.ends;
        self.marked_stuck.copy_from_slice(&self.state.stuck);
        self.marked_following.copy_from_slice(&self.state.following);
    }

    /// Goes back to the state kept last.
    pub fn retreat(&mut self) {
        for (history, mark) in self.state.histories.iter_mut().zip(&self.marks) {
            history.rewind(mark);
        }
        self.state.ends = self.marked;
        self.state.stuck.copy_from_slice(&self.marked_stuck);
        self.state.following.copy_from_slice(&self.marked_following);
    }

    /// Energy of the waves, the drive, the hoist's spring and what the losses stand on (J).
    pub fn stored(&self) -> f64 {
        let Self { description, state, .. } = self;
        let mut energy = description.drive.energy(&state.ends.drive);
        energy += description.hoist.map_or(0.0, |hoist| hoist.energy(&state.ends.hoist));
        let kinds = if description.hoist.is_some() { 2 } else { 1 };
        for (piece, history) in description.pieces.iter().zip(&state.histories) {
            for (kind, wave) in [piece.torsion, piece.axial].into_iter().enumerate().take(kinds) {
                let entered = history.at(history.newest() - wave.delay);
                let squares =
                    history.square_since(&entered, down(0, kind)) + history.square_since(&entered, up(0, kind));
                energy += wave.impedance * squares;
            }
        }
        for (piece, speeds) in description.pieces.iter().zip(&state.following) {
            for (wave, speed) in [piece.torsion, piece.axial].iter().zip(speeds).take(kinds) {
                energy += 0.5 * FOLLOWS_WITHIN * wave.drag * speed * speed;
            }
        }
        energy
    }

    /// Energy lost so far (J): to friction on the wall, and by the attenuation of waves.
    pub fn lost(&self) -> [f64; 2] {
        [self.state.ends.friction, self.state.ends.attenuation]
    }

    /// Work of the hoist's block so far (J).
    pub fn hoist_work(&self) -> f64 {
        self.state.ends.hoist_work
    }

    /// The top drive now.
    pub fn drive(&self) -> &DriveState {
        &self.state.ends.drive
    }

    /// The hoist now, if there is one.
    pub fn hoist(&self) -> Option<&HoistState> {
        self.description.hoist.map(|_| &self.state.ends.hoist)
    }

    /// Torque (N m) and axial force (N, against advance) of the wall's friction on the string now.
    pub fn drag(&self) -> [f64; 2] {
        self.state.ends.drag
    }

    /// Axial force on the tool's top now (N), compressing; 0 without a hoist.
    pub fn force_on_tool(&self) -> f64 {
        self.state.ends.force_on_tool
    }

    /// Load on the hook (N): the string's weight less what is slacked off.
    pub fn hook_load(&self) -> f64 {
        let hoist = self.description.hoist;
        self.description.weight - hoist.map_or(0.0, |hoist| hoist.stiffness * self.state.ends.hoist.compression)
    }

    /// Whether the drive's torque is at its limit.
    pub fn is_drive_at_limit(&self) -> bool {
        self.description.drive.is_at_limit(&self.state.ends.drive)
    }

    /// The state, to be saved.
    #[cfg(feature = "checkpoints")]
    pub fn state(&self) -> &StringState {
        &self.state
    }

    /// Whether a saved state is one of this string.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, state: &StringState) -> bool {
        let (mine, saved) = (&self.state.histories, &state.histories);
        saved.len() == mine.len()
            && saved.iter().zip(mine).all(|(saved, mine)| saved.fits(mine))
            && state.stuck.len() == self.state.stuck.len()
            && state.following.len() == self.state.following.len()
    }

    /// Continues from a saved state that fits.
    #[cfg(feature = "checkpoints")]
    pub fn restore(&mut self, state: &StringState) {
        for (mine, saved) in self.state.histories.iter_mut().zip(&state.histories) {
            mine.copy_from(saved);
        }
        self.state.ends = state.ends;
        self.state.stuck.copy_from_slice(&state.stuck);
        self.state.following.copy_from_slice(&state.following);
    }
}
