//! A cantilever and a clamped rod against their closed forms: how a description is built by hand, and how right the
//! elements are.
//!
//!     cargo run --release -p flexdrill-core --example beam

use std::f64::consts::PI;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{
    Body, Direction, LoadHistory, Location, PointLoad, Rayleigh, Support, ToolDescription, Tube, WellDescription,
    WellSection, WobPath,
};
use flexdrill_core::twin::{Simulation, SimulationSettings};

/// m.
const LENGTH: f64 = 1.0;
/// m, of a solid bar.
const DIAMETER: f64 = 0.03;

/// A horizontal bar, clamped at the top, alone: no gravity, no contact, the guide held.
fn bar(load: PointLoad) -> ToolDescription {
    use Direction::{PhiY, PhiZ, Psi, U, V, W};
    let well = WellDescription {
        start_inclination: 0.5 * PI,
        sections: vec![WellSection::Straight { length: LENGTH }],
    };
    let bar = Tube {
        outer_diameter: DIAMETER,
        inner_diameter: 0.0,
    };
    let guide = ToolDescription::paper().guide_section;
    ToolDescription::new(well, 0.118, 1, bar, guide).with(|tool| {
        tool.guide_fixed = true;
        tool.rayleigh = Rayleigh { alpha: 0.0, beta: 0.0 };
        (tool.inner.stiffness, tool.outer.stiffness) = (0.0, 0.0);
        tool.gravity = 0.0;
        tool.supports = vec![Support {
            location: Location::Top,
            body: Body::Pipe,
            directions: vec![U, V, W, Psi, PhiY, PhiZ],
        }];
        tool.drive_top = false;
        tool.wob_path = WobPath::Guide;
        tool.loads = vec![load];
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let youngs_modulus = 206e9;
    let settings = SimulationSettings::default();
    let row = |what: &str, closed_form: f64, computed: f64| {
        println!(
            "{what:<34} {closed_form:>14.6e} {computed:>14.6e} {:>9.1e}",
            computed / closed_form - 1.0
        );
    };
    println!("{:<34} {:>14} {:>14} {:>9}", "", "closed form", "computed", "relative");

    // At rest under 100 N across its end.
    let force = 100.0;
    let across = PointLoad {
        location: Location::Bottom,
        body: Body::Pipe,
        direction: Direction::W,
        history: LoadHistory::Constant(force),
    };
    let twin = Simulation::new(&bar(across), &settings)?;
    let bending = youngs_modulus * PI / 64.0 * DIAMETER.powi(4);
    let tip = |direction| {
        twin.displacement(twin.last_station(), Body::Pipe, direction)
            .unwrap_or(f64::NAN)
    };
    row(
        "tip deflection F L^3 / 3 E I (m)",
        force * LENGTH.powi(3) / (3.0 * bending),
        tip(Direction::W),
    );
    row(
        "tip tilt -F L^2 / 2 E I (rad)",
        -force * LENGTH.powi(2) / (2.0 * bending),
        tip(Direction::PhiY),
    );

    // Let go: the first bending frequency, from upward crossings of the tip over 20 periods.
    let gone = PointLoad {
        location: Location::Bottom,
        body: Body::Pipe,
        direction: Direction::W,
        history: LoadHistory::Table(vec![(0.0, force), (1e-9, 0.0)]),
    };
    let tool = bar(gone);
    let settings = settings.with(|settings| settings.time_step = 0.1e-3);
    let mut twin = Simulation::new(&tool, &settings)?;
    let mut crossings = Vec::new();
    let mut before = 0.0;
    while crossings.len() < 21 {
        twin.advance(&Inputs::default()).ok()?;
        let now = twin
            .displacement(twin.last_station(), Body::Pipe, Direction::W)
            .unwrap_or(f64::NAN);
        if before < 0.0 && now >= 0.0 {
            crossings.push(twin.time() - settings.time_step * now / (now - before));
        }
        before = now;
    }
    let per_length = 7850.0 * 0.25 * PI * DIAMETER.powi(2);
    let closed_form = 1.875_104_07_f64.powi(2) / (2.0 * PI * LENGTH.powi(2)) * (bending / per_length).sqrt();
    row(
        "first frequency (Hz)",
        closed_form,
        20.0 / (crossings[20] - crossings[0]),
    );
    Ok(())
}
