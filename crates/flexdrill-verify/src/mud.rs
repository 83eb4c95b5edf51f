//! Mud: what it adds to the mass of pipe and guide, and what its viscosity takes.

use std::f64::consts::PI;

use super::case::{CaseTwin, crossing_frequency};
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// Frequencies: Newmark's own error is 2e-5, and the crossings of some twenty periods are found to 1e-5 of one.
const FREQUENCY: f64 = 1e-4;
/// Damping ratio: peaks are found by parabolas through samples of 1/400 of a period; higher modes, which decay faster, add
/// some 1e-3 of the amplitude to the first ones.
const DAMPING: f64 = 5e-3;
/// Newton leaves up to 1e-5 of the force.
const AS_ONE: f64 = 1e-5;
/// The inertia takes 5e-4 of the force at the start of the way, and steps are a thousandth of its time.
const SQUEEZE: f64 = 1e-3;
/// A hundredth of the mass is compared: Newton leaves up to 1e-5 of the force.
const TOGETHER: f64 = 1e-3;

/// The tool and mud of a case.
struct Case {
    pipe: SectionProperties,
    guide: SectionProperties,
    /// Radii: bore of the pipe, annulus inside the guide, annulus in the hole (m).
    bore: f64,
    inner: [f64; 2],
    outer: [f64; 2],
    density: f64,
    kinematic: f64,
    length: f64,
}

impl Case {
    fn of(twin: &CaseTwin) -> Result<Self, VerifyError> {
        let tool = twin.config.tool();
        let missing = VerifyError::Missing {
            case: "mud",
            what: "its mud",
        };
        let mud = tool.mud.ok_or(missing)?;
        let (pipe, guide) = (tool.pipe_sections[0], tool.guide_section);
        Ok(Self {
            pipe: SectionProperties::of(pipe, tool.material, 1.0),
            guide: SectionProperties::of(guide, tool.material, 1.0),
            bore: 0.5 * pipe.inner_diameter,
            inner: [0.5 * pipe.outer_diameter, 0.5 * guide.inner_diameter],
            outer: [0.5 * guide.outer_diameter, 0.5 * tool.hole_diameter],
            density: mud.density,
            kinematic: mud.viscosity / mud.density,
            length: twin.config.well.length(),
        })
    }

    /// Mass of the mud in a circle (kg/m).
    fn disc(&self, radius: f64) -> f64 {
        self.density * PI * radius * radius
    }

    /// m of an annulus (kg/m).
    fn between(&self, [a, b]: [f64; 2]) -> f64 {
        2.0 * self.disc(a) * b * b / (b * b - a * a)
    }

    /// Mass per length over pipe and guide: pipe, coupling, guide (kg/m).
    fn mass(&self) -> [f64; 3] {
        let (inner, outer) = (self.between(self.inner), self.between(self.outer));
        [
            self.pipe.mass + self.disc(self.bore) + inner - self.disc(self.inner[0]),
            -inner,
            self.guide.mass + inner + self.disc(self.inner[1]) + outer - self.disc(self.outer[0]),
        ]
    }

    /// Stiffness of the first bending mode per length (N/m2).
    fn stiffness(&self, section: &SectionProperties) -> f64 {
        (PI / self.length).powi(4) * section.bending
    }

    /// First mode of the deflection of a body (m).
    fn first_mode(twin: &CaseTwin, body: Body) -> f64 {
        let last = twin.last();
        let shape = |s: usize| (s as f64 * PI / last as f64).sin();
        let sum: f64 = (0..=last)
            .map(|s| shape(s) * twin.displacement(s, body, Direction::W))
            .sum();
        2.0 * sum / last as f64
    }
}

/// The first mode's samples after the impact.
fn swing(twin: &mut CaseTwin, until: f64, mut take: impl FnMut(&CaseTwin)) -> Result<f64, VerifyError> {
    while twin.time() < until {
        twin.step()?;
        if twin.time() > 0.002 {
            take(twin);
        }
    }
    Ok(twin.simulation.settings().time_step)
}

pub(super) fn pipe() -> Result<Vec<Row>, VerifyError> {
    let case = "mud_pipe";
    // The same missing value is reported wherever the swing cannot be found.
    let mut twin = CaseTwin::new(case)?;
    let of = Case::of(&twin)?;
    let none = VerifyError::Missing { case, what: "a swing" };
    let mut samples = Vec::new();
    // The swing is that of the first mode, projected out of all stations,
    // so that higher modes do not disturb the crossings.
    let dt = swing(&mut twin, 1.0, |twin| samples.push(Case::first_mode(twin, Body::Pipe)))?;
    // First without viscosity: the added mass alone shifts the frequency.
    let [wet, ..] = of.mass();
    let frequency = |mass: f64| (of.stiffness(&of.pipe) / mass).sqrt() / (2.0 * PI);
    let got = crossing_frequency(&samples, dt).ok_or(none)?;
    let mut rows = vec![
        Row::relative(case, "frequency of the wet pipe (Hz)", frequency(wet), got, FREQUENCY),
        Row::relative(
            case,
            "wet over dry frequency, sqrt(18.157 / 33.668) (-)",
            0.7344,
            got / frequency(of.pipe.mass),
            // Printed to four digits.
            2.0 * FREQUENCY,
        ),
    ];
    // The second run differs in the viscosity alone, and so does what is compared.
    let mut damped = CaseTwin::with(case, |config| config.with_value("environment.mud.damping", "viscous"))?;
    let omega = 2.0 * PI * damped.config.tool().mud.map_or(0.0, |mud| mud.frequency);
    let mut samples = Vec::new();
    let dt = swing(&mut damped, 1.0, |twin| {
        samples.push(Case::first_mode(twin, Body::Pipe))
    })?;
    // The real part of the oscillating film adds mass, the imaginary one
    // damps; both follow from the frequency that is configured.
    let [real, imaginary] = of.oscillating(omega);
    let between = of.between(of.inner);
    let mass = of.pipe.mass + of.disc(of.bore) + between * real - of.disc(of.inner[0]);
    let (drag, natural) = (omega * between * imaginary, 2.0 * PI * frequency(mass));
    let ratio = drag / (2.0 * mass * natural);
    // The damped frequency is lower than the natural one; the twin shows the damped one.
    let swinging = natural * (1.0 - ratio * ratio).sqrt() / (2.0 * PI);
    let got = crossing_frequency(&samples, dt).ok_or(VerifyError::Missing { case, what: "a swing" })?;
    rows.push(Row::relative(
        case,
        "frequency with viscosity (Hz)",
        swinging,
        got,
        FREQUENCY,
    ));
    // The decrement between maxima gives the ratio without knowledge of mass or stiffness.
    let decrement = log_decrement(&samples).ok_or(VerifyError::Missing { case, what: "a decay" })?;
    let got = decrement / decrement.hypot(2.0 * PI);
    rows.push(Row::relative(
        case,
        "damping ratio c / (2 m_t omega) (-)",
        ratio,
        got,
        DAMPING,
    ));
    Ok(rows)
}

impl Case {
    /// k' and k'' of the annulus in the guide at an angular frequency (rad/s).
    fn oscillating(&self, omega: f64) -> [f64; 2] {
        let [a, b] = self.inner;
        let x = 0.5 * (b - a) / (2.0 * self.kinematic / omega).sqrt();
        let q = (a * a - a * b + b * b) / (a * b);
        // tanh((1 + i) x), over (1 + i) x.
        let below = (2.0 * x).cosh() + (2.0 * x).cos();
        let (re, im) = ((2.0 * x).sinh() / below, (2.0 * x).sin() / below);
        let (re, im) = (0.5 * (re + im) / x, 0.5 * (im - re) / x);
        let square = (1.0 - re) * (1.0 - re) + im * im;
        [1.0 + q * ((1.0 - re) / square - 1.0), -q * im / square]
    }
}

/// Mean logarithmic decrement per period, from the first peak to that of a tenth of its height.
fn log_decrement(samples: &[f64]) -> Option<f64> {
    let peaks: Vec<f64> = samples
        .windows(3)
        .filter(|x| x[1] > 0.0 && x[1] >= x[0] && x[1] > x[2])
        .map(|x| {
            let (slope, bend) = (0.5 * (x[2] - x[0]), x[0] - 2.0 * x[1] + x[2]);
            x[1] - 0.5 * slope * slope / bend
        })
        .collect();
    let first = *peaks.first()?;
    let last = peaks.iter().position(|peak| *peak < 0.1 * first)?;
    Some((first / peaks[last]).ln() / last as f64)
}

pub(super) fn coupled() -> Result<Vec<Row>, VerifyError> {
    let case = "mud_coupled";
    let mut twin = CaseTwin::new(case)?;
    let of = Case::of(&twin)?;
    let [pipe, coupling, guide] = of.mass();
    let (k_pipe, k_guide) = (of.stiffness(&of.pipe), of.stiffness(&of.guide));
    // det(K - omega^2 M) = 0.
    let (a, c) = (pipe * guide - coupling * coupling, k_pipe * k_guide);
    let b = pipe * k_guide + guide * k_pipe;
    let root = (b * b - 4.0 * a * c).sqrt();
    let squares = [(b - root) / (2.0 * a), (b + root) / (2.0 * a)];
    // Each mode's coordinate, which the other does not reach: its shape times M.
    let shapes = squares.map(|square| [square * coupling, k_pipe - square * pipe]);
    let mut modes = [vec![], vec![]];
    let dt = swing(&mut twin, 2.0, |twin| {
        let x = [Body::Pipe, Body::Guide].map(|body| Case::first_mode(twin, body));
        for (samples, shape) in modes.iter_mut().zip(shapes) {
            let momentum = [pipe * x[0] + coupling * x[1], coupling * x[0] + guide * x[1]];
            samples.push(shape[0] * momentum[0] + shape[1] * momentum[1]);
        }
    })?;
    let printed = [24.376, 34.557];
    let mut rows = Vec::new();
    for (n, (square, samples)) in squares.into_iter().zip(&modes).enumerate() {
        let got = crossing_frequency(samples, dt).ok_or(VerifyError::Missing { case, what: "a swing" })?;
        let expected = square.sqrt() / (2.0 * PI);
        let quantity = format!("coupled frequency {}, {} Hz (Hz)", n + 1, printed[n]);
        rows.push(Row::relative(case, quantity, expected, got, FREQUENCY));
        rows.push(Row::relative(
            case,
            "its printed value (Hz)",
            printed[n],
            got,
            FREQUENCY,
        ));
    }
    Ok(rows)
}

pub(super) fn together() -> Result<Vec<Row>, VerifyError> {
    let case = "mud_together";
    let of = Case::of(&CaseTwin::new(case)?)?;
    let dry = of.pipe.mass + of.guide.mass + of.disc(of.bore);
    let around = of.between(of.outer) - of.disc(of.outer[0]);
    let carried = [
        of.pipe.mass + of.disc(of.bore) - of.disc(of.inner[0]),
        of.guide.mass + of.disc(of.inner[1]) + around,
    ];
    // 10 m/s2, half of the force on each end.
    let [on_pipe, on_guide] = carried.map(|mass| 5.0 * mass * of.length);
    let mut twin = CaseTwin::with(case, |config| {
        config
            .with_value("loads.0.history.constant", on_pipe)?
            .with_value("loads.1.history.constant", on_pipe)?
            .with_value("loads.2.history.constant", on_guide)?
            .with_value("loads.3.history.constant", on_guide)
    })?;
    let time = 0.1;
    twin.run_to(time)?;
    let mean = |body| 0.5 * (twin.displacement(0, body, Direction::W) + twin.displacement(1, body, Direction::W));
    let [pipe, guide] = [Body::Pipe, Body::Guide].map(mean);
    let total = 2.0 * (on_pipe + on_guide) * time * time / (2.0 * pipe * of.length);
    let between = of.disc(of.inner[1]) - of.disc(of.inner[0]);
    Ok(vec![
        Row::relative(case, "guide and pipe move as one (m)", pipe, guide, AS_ONE),
        Row::relative(
            case,
            "rho pi (b^2 - a^2) between them (kg/m)",
            between,
            total - dry - around,
            TOGETHER,
        ),
        Row::relative(case, "its printed value (kg/m)", 2.100, total - dry - around, TOGETHER),
    ])
}

pub(super) fn squeeze() -> Result<Vec<Row>, VerifyError> {
    let case = "mud_squeeze";
    let mut twin = CaseTwin::new(case)?;
    let of = Case::of(&twin)?;
    // The closed form is that of a narrow film, whose width is small against the radius.
    let (width, viscosity) = (of.inner[1] - of.inner[0], of.kinematic * of.density);
    let film = 12.0 * PI * viscosity * (of.inner[0] / width).powi(3);
    let reached = |eccentricity: f64| eccentricity / (1.0 - eccentricity * eccentricity).sqrt() - eccentricity;
    let load = 100.0;
    let mut rows = Vec::new();
    // Times are compared between these eccentricities: the start, in which the pipe gains its speed, is left out.
    let ends = [0.8, 0.9, 0.95];
    let mut times = Vec::new();
    let (mut before, last) = (0.0, twin.last());
    while times.len() < ends.len() && twin.time() < 5.0 {
        twin.step()?;
        let now = twin.displacement(last, Body::Pipe, Direction::W) / width;
        // The crossing is interpolated within the step, or the step would be the error of the time.
        if now >= ends[times.len()] {
            let step = twin.simulation.settings().time_step;
            times.push(twin.time() - step * (now - ends[times.len()]) / (now - before));
        }
        before = now;
    }
    for k in 1..ends.len() {
        let expected = film * width / load * (reached(ends[k]) - reached(ends[k - 1]));
        // A run that does not get there has NaN, which no tolerance accepts.
        let got = match (times.get(k - 1), times.get(k)) {
            (Some(start), Some(end)) => end - start,
            _ => f64::NAN,
        };
        let quantity = format!("time from eps {} to {} (s)", ends[k - 1], ends[k]);
        rows.push(Row::relative(case, quantity, expected, got, SQUEEZE));
    }
    // The work of the load is what the film has taken, because nothing else moves.
    let audit = twin.simulation.energy();
    let worked = audit.loads.abs();
    rows.push(Row::scaled(
        case,
        "work that the film takes (J)",
        audit.loads,
        audit.mud,
        worked,
        SQUEEZE,
    ));
    rows.push(Row::scaled(
        case,
        "error of the energy audit (J)",
        0.0,
        audit.error,
        worked,
        AS_ONE,
    ));
    Ok(rows)
}
