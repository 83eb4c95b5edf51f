//! Helical buckling of a thin pipe on the wall of a level hole, by runs of the model.

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

const CASE: &str = "helical_buckling";
/// A turn that gravity pulls at is uneven: it takes w / (5 EI r k^4) = 0.1 rad of phase, which lowers the energy of the
/// helix by 2.5 % of w r and the load by 1.25 %. The published load is that of the even helix.
const LIMIT: f64 = 0.03;
/// The loads that are run, over the published one.
const LOADS: [f64; 2] = [0.95, 1.05];
/// Turns of the pipes whose energies are subtracted, so that those of their ends cancel.
const TURNS: [usize; 2] = [2, 4];
/// Elements per turn, and pushes that lay a turn on the wall.
const ELEMENTS: usize = 12;
const PUSHES: usize = 3;
/// The couples at the ends of the helix among the loads.
const COUPLES: [usize; 2] = [15, 16];
/// When the pipe is at rest (s).
const REST: f64 = 8.0;

/// A pipe of some turns at rest under an axial load (N).
struct Pipe {
    turns: usize,
    load: f64,
    twin: CaseTwin,
}

impl Pipe {
    /// Laid on the wall as a helix, or left on the low side.
    fn at_rest(turns: usize, load: f64, is_helix: bool) -> Result<Self, VerifyError> {
        let all = TURNS[1];
        let mut twin = CaseTwin::within(CASE, 1e-2, |config| {
            let length = config.well.length() * turns as f64 / all as f64;
            let mut config = config.with_value("loads.0.history.constant", -load)?;
            for push in 0..PUSHES * all {
                let load = format!("loads.{}", push + 1);
                if push >= PUSHES * turns {
                    config = config.with_value(&format!("{load}.at.station"), 1)?;
                }
                if push >= PUSHES * turns || !is_helix {
                    for point in 0..2 {
                        config = config.with_value(&format!("{load}.history.table.{point}.1"), 0.0)?;
                    }
                }
            }
            for couple in COUPLES.into_iter().filter(|_| !is_helix) {
                config = config.with_value(&format!("loads.{couple}.history.constant"), 0.0)?;
            }
            config
                .with_value("tool.elements_per_link", ELEMENTS * turns)?
                .with_value("well.sections.0.straight.length", length)
        })?;
        twin.run_to(REST)?;
        Ok(Self { turns, load, twin })
    }

    /// Potential energy less that at the start (J): elastic and of the contacts, of the weight, and of the axial load.
    fn energy(&self) -> f64 {
        let audit = self.twin.simulation.energy();
        let shortened = -self.twin.displacement(self.twin.last(), Body::Pipe, Direction::U);
        audit.stored - audit.gravity - self.load * shortened
    }

    /// Stations of the turn in the middle.
    fn middle(&self) -> std::ops::Range<usize> {
        let first = ELEMENTS * (self.turns - 1) / 2;
        first..first + ELEMENTS
    }

    /// Whether the turn in the middle lies on the wall all round, but for a hundredth of the clearance: at the top its
    /// weight nearly lifts it off.
    fn is_round(&self) -> bool {
        let clearance = self.twin.config.inner_clearance();
        self.middle().all(|station| {
            let at = |direction| self.twin.displacement(station, Body::Pipe, direction);
            at(Direction::V).hypot(at(Direction::W)) > 0.99 * clearance
        })
    }

    /// Force on the wall of the turn in the middle (N).
    fn on_the_wall(&self) -> f64 {
        self.middle().map(|station| self.twin.inner_normal(station)).sum()
    }
}

/// Energy of a turn of the helix beyond that of the straight pipe (J), and its force on the wall (N), under `load` (N).
fn turn(load: f64) -> Result<[f64; 2], VerifyError> {
    let mut of_turns = [0.0; 2];
    let mut force = 0.0;
    for (energy, turns) in of_turns.iter_mut().zip(TURNS) {
        let helix = Pipe::at_rest(turns, load, true)?;
        let straight = Pipe::at_rest(turns, load, false)?;
        *energy = helix.energy() - straight.energy();
        if turns == TURNS[1] {
            if !helix.is_round() {
                return Err(VerifyError::Missing {
                    case: CASE,
                    what: "a helix that lies on the wall",
                });
            }
            force = helix.on_the_wall();
        }
    }
    Ok([(of_turns[1] - of_turns[0]) / (TURNS[1] - TURNS[0]) as f64, force])
}

/// The load at which both energies are equal, and the force on the wall there.
pub(super) fn buckling() -> Result<Vec<Row>, VerifyError> {
    let config = CaseTwin::new(CASE)?.config.clone();
    let (tool, clearance) = (config.tool(), config.inner_clearance());
    let section = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let weight = section.mass * tool.gravity;
    let expected = (8.0 * section.bending * weight / clearance).sqrt();
    let loads = LOADS.map(|part| part * expected);
    let ([low, push_low], [high, push_high]) = (turn(loads[0])?, turn(loads[1])?);
    let part = low / (low - high);
    let load = loads[0] + part * (loads[1] - loads[0]);
    let pitch = config.well.length() / TURNS[1] as f64;
    let force = (push_low + part * (push_high - push_low)) / pitch;
    let per_length = clearance * load * load / (4.0 * section.bending);
    Ok(vec![
        Row::relative(CASE, "2 sqrt(2) sqrt(EI w / r) (N)", expected, load, LIMIT),
        Row::relative(
            CASE,
            "force on the wall then, r F^2 / 4EI (N/m)",
            per_length,
            force,
            LIMIT,
        ),
    ])
}
