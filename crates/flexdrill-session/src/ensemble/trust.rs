//! Which of the rig's sensors the members are weighed by.
//!
//! A sensor is not believed where its window is further from what every member does than the stated errors explain, and where
//! it shows one value while all members move. What such a sensor has said before is withdrawn, because nothing says since when
//! it has been wrong. The alarms of the twin and `rig_disagrees` do not depend on it.

use super::evidence::Compared;
use flexdrill_calibration::residual::RigQuantity;

/// Stated errors of twin and offset by which a window's mean must be beyond what every plausible tool does, to one side of
/// all, for its sensor to count as one that lies. Of a normal error one in 30,000 is beyond four to one side. Weighed, such a
/// mean would choose the tools that are the least wrong, and narrow the bands about what no tool does.
const BEYOND: f64 = 4.0;
/// Standard deviations of a sample's stated noise by which the readings of every member must have moved for a sensor that has
/// not to count as stuck: of no sensor is the resolution coarser than its noise by so much.
const MOVED: f64 = 4.0;
/// Range of a sensor's values within which it has not moved, as a share of its stated noise: ten values of a sensor that works
/// lie within a range of three standard deviations.
const CONSTANT: f64 = 0.1;
/// The same as a share of the value, for a sensor without noise: rounding.
const ROUNDED: f64 = 1e-9;
/// Windows in a row that no member explains, after which what a sensor said before is withdrawn: one may be an event of the
/// drilling.
const WINDOWS: u32 = 2;

/// Why a sensor is not believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Doubt {
    /// Its newest window is beyond what any member does.
    Beyond,
    /// It shows one value while all members move.
    Stuck,
}

impl Doubt {
    /// In words, after the name of the sensor.
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Beyond => {
                "it is further from what each plausible tool does than the stated errors of twin and sensor explain: its \
                 limit, its sign, its unit, or another value in its place"
            }
            Self::Stuck => {
                "it has shown one value while the torque, load or speed of every plausible tool changed: it is stuck"
            }
        }
    }
}

/// What is known of a sensor.
#[derive(Debug, Clone, Copy, Default)]
struct Sensor {
    /// Lowest and highest value since it was constant.
    held: Option<[f64; 2]>,
    /// Time for which all members have moved meanwhile (s).
    moved: f64,
    /// Windows in a row that no member explains.
    beyond: u32,
    stuck: bool,
    /// Whether members have been weighed by it.
    weighed: bool,
}

/// What is known of all sensors.
#[derive(Debug, Clone, Default)]
pub(super) struct Trust([Sensor; RigQuantity::COUNT]);

/// Which quantities no plausible tool explains, from the residuals of all members in a window over their stated errors.
fn unexplained(members: &[[Option<f64>; RigQuantity::COUNT]], index: usize) -> Option<bool> {
    let mut residuals = members.iter().filter_map(|member| member[index]).peekable();
    // A window without a measurement says nothing of its sensor.
    let first = residuals.peek().copied()?;
    Some(residuals.all(|residual| residual * first.signum() > BEYOND))
}

impl Trust {
    /// Why a sensor is not believed.
    pub(super) fn doubt(&self, quantity: RigQuantity) -> Option<Doubt> {
        let sensor = &self.0[quantity as usize];
        match (sensor.stuck, sensor.beyond) {
            (true, _) => Some(Doubt::Stuck),
            (false, 0) => None,
            _ => Some(Doubt::Beyond),
        }
    }

    /// Takes what the rig measures. `noise` is that of a sample of each quantity. Returns which sensors have begun to show
    /// another value, so that what the members move is counted from here on.
    pub(super) fn measured(
        &mut self,
        compared: &Compared,
        noise: impl Fn(RigQuantity) -> f64,
    ) -> [bool; RigQuantity::COUNT] {
        RigQuantity::ALL.map(|quantity| {
            let (sensor, value) = (&mut self.0[quantity as usize], compared.measured[quantity as usize]);
            if !value.is_finite() {
                return false;
            }
            let [low, high] = sensor.held.unwrap_or([value; 2]);
            let [low, high] = [low.min(value), high.max(value)];
            let within = (CONSTANT * noise(quantity)).max(ROUNDED * value.abs());
            let constant = sensor.held.is_some() && high - low <= within;
            if constant {
                sensor.held = Some([low, high]);
            } else {
                (sensor.held, sensor.moved, sensor.stuck) = (Some([value; 2]), 0.0, false);
            }
            !constant
        })
    }

    /// Takes by how much the readings of each member have moved since a sensor was constant. `patience` is how late a
    /// sensor may follow (s). Returns whether it has become stuck.
    pub(super) fn moved(
        &mut self,
        quantity: RigQuantity,
        step: f64,
        members: impl Iterator<Item = f64>,
        [noise, patience]: [f64; 2],
    ) -> bool {
        let sensor = &mut self.0[quantity as usize];
        let least = members.fold(f64::INFINITY, f64::min);
        let has_moved = least.is_finite() && least > MOVED * noise && least > 0.0;
        sensor.moved = if has_moved { sensor.moved + step } else { 0.0 };
        let stuck = sensor.held.is_some() && sensor.moved > patience;
        let becomes = stuck && !sensor.stuck;
        sensor.stuck |= stuck;
        becomes
    }

    /// Takes the residuals of all members in a window that ends, over their stated errors. Returns the sensors that the window
    /// does not count for.
    pub(super) fn window(&mut self, members: &[[Option<f64>; RigQuantity::COUNT]]) -> [bool; RigQuantity::COUNT] {
        RigQuantity::ALL.map(|quantity| {
            let sensor = &mut self.0[quantity as usize];
            if let Some(beyond) = unexplained(members, quantity as usize) {
                sensor.beyond = if beyond { sensor.beyond + 1 } else { 0 };
                sensor.weighed |= !beyond && !sensor.stuck;
            }
            self.doubt(quantity).is_some()
        })
    }

    /// Which sensors have weighed members before they turned out to be wrong. They are given once.
    pub(super) fn withdrawn(&mut self) -> Vec<RigQuantity> {
        let wrong = |sensor: &Sensor| sensor.weighed && (sensor.stuck || sensor.beyond >= WINDOWS);
        let quantities = RigQuantity::ALL.into_iter();
        let withdrawn: Vec<RigQuantity> = quantities
            .filter(|quantity| wrong(&self.0[*quantity as usize]))
            .collect();
        for quantity in &withdrawn {
            self.0[*quantity as usize].weighed = false;
        }
        withdrawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TORQUE: RigQuantity = RigQuantity::SurfaceTorque;

    /// Seconds of a sensor with a noise of 5 and members whose readings have moved by `moved`; whether it is stuck after each.
    fn seconds(trust: &mut Trust, shown: &[f64], moved: f64) -> Vec<bool> {
        let second = |value: &f64| {
            let mut compared = Compared {
                step: 1.0,
                steady: false,
                drilling: true,
                measured: [f64::NAN; RigQuantity::COUNT],
                predicted: [1.0; RigQuantity::COUNT],
            };
            compared.measured[TORQUE as usize] = *value;
            let restarts = trust.measured(&compared, |_| 5.0)[TORQUE as usize];
            let moved = if restarts { 0.0 } else { moved };
            trust.moved(TORQUE, 1.0, [moved, 3.0 * moved].into_iter(), [5.0, 10.0]);
            trust.doubt(TORQUE) == Some(Doubt::Stuck)
        };
        shown.iter().map(second).collect()
    }

    #[test]
    fn a_constant_value_is_stuck_once_all_tools_have_moved_for_longer_than_it_may_be_late() {
        let mut trust = Trust::default();
        assert_eq!(
            seconds(&mut trust, &[300.0; 60], 19.0),
            [false; 60],
            "four times the noise"
        );
        let after = seconds(&mut trust, &[300.2; 12], 21.0);
        assert_eq!(after.iter().position(|stuck| *stuck), Some(10), "{after:?}");
        // A value that is missing says nothing; one that moves is that of a sensor that works.
        assert_eq!(seconds(&mut trust, &[f64::NAN, 301.0], 21.0), [true, false]);
        assert_eq!(trust.doubt(TORQUE), None);
    }

    #[test]
    fn a_sensor_that_scatters_is_not_stuck_whatever_the_tools_do() {
        let shown: Vec<f64> = (0..100).map(|second| 300.0 + f64::from(second % 2)).collect();
        let mut trust = Trust::default();
        assert_eq!(seconds(&mut trust, &shown, 500.0), [false; 100]);
    }

    #[test]
    fn what_was_said_is_withdrawn_once_after_two_windows_beyond_all_tools() {
        let window = |residuals: [f64; 2]| {
            residuals.map(|residual| {
                let mut of = [None; RigQuantity::COUNT];
                of[TORQUE as usize] = Some(residual);
                of
            })
        };
        let mut trust = Trust::default();
        let mut take = |residuals| {
            let leaves_out = trust.window(&window(residuals))[TORQUE as usize];
            (leaves_out, trust.withdrawn().len())
        };
        // Members on both sides, or one within four errors, explain it. A sensor that weighed nothing has nothing to withdraw.
        assert_eq!(take([5.0, 6.0]), (true, 0));
        assert_eq!(take([5.0, 6.0]), (true, 0));
        assert_eq!(take([-5.0, 5.0]), (false, 0));
        assert_eq!(take([3.9, 50.0]), (false, 0));
        assert_eq!(take([-4.1, -50.0]), (true, 0));
        assert_eq!(take([-4.1, -50.0]), (true, 1));
        assert_eq!(take([-4.1, -50.0]), (true, 0));
        assert_eq!(take([0.0, 0.0]), (false, 0));
        // Without a measurement the doubt stays as it is.
        assert_eq!(trust.window(&[[None; RigQuantity::COUNT]]), [false; RigQuantity::COUNT]);
    }
}
