//! The curvature that a guide drills to, in closed form.
//!
//! The guide rests on the bit and, from a free length l behind it on, on the wall. Thrust on the curved guide and its
//! weight load it with p = W kb + q sin(inc). With D = kb - kf, u = p l2/EI, P = eta W_a l2/EI and eps = W/(eta W_a), the
//! free span has
//!
//! ```text
//! tilt  t = D l/2 - p l3/(12 EI),   side force  F = EI D/l + p l/2,   gap  c = u l2/24 - D l2/6
//! steady:  (1 - eps) t + F/(eta W_a) = 0,   so   D = u [(1 - eps)/12 - 1/(2P)] / [(1 - eps)/2 + 1/P]
//! ```
//!
//! A guide in pieces has a free curvature kf(s) from the bit up. With A0 and A1 the integrals of kf and of s kf over the free
//! span, and k the free curvature where the span meets the wall,
//!
//! ```text
//! t = kb l/2 - A0 + k l/2 - p l3/(12 EI),   F = EI (kb - k)/l + p l/2,   c = p l4/(24 EI) - kb l2/6 + A1 - k l2/3
//! ```
//!
//! `Span` solves them. Where a piece ends at the wall, k is between those of both pieces. The pieces above the free span are
//! taken to lie on the wall.
//!
//! A spine off the guide's axis adds e W/EI to the free curvature, up to that at which the slots are shut (`Guide::under`).
//!
//! The formulas leave out the thrust on the deflected span (W w'', which lowers l by some per cent) and the change of
//! curvature across the gap (kb2 w). For guides below 0.1 of a tube's stiffness in a short arc that is 1 % of the
//! curvature; in level holes, where W l2/EI exceeds 1, use [`Propagation`](crate::Propagation).

use crate::{BitLaw, Guide, HoleError};

/// What a guide and a bit drill to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steady {
    /// kb: build curvature of the hole (1/m).
    pub curvature: f64,
    /// l: length between bit and first contact with the wall (m).
    pub free_length: f64,
    /// P = eta W_a l2/EI: lateral resistance of the bit against that of the guide. Below
    /// [`RIPPLE_THRESHOLD`](crate::RIPPLE_THRESHOLD) the hole ripples.
    pub steering_number: f64,
}

/// Curvatures (1/m) between which a guide drills, whatever the bit. Of a guide in pieces the smaller and the larger one of what
/// a bit drills that cuts until no side force acts on it, and of what one drills that drills where it points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// kf - sqrt(2 p c/EI) with one kf: a bit that cuts until no side force acts on it.
    pub low: f64,
    /// kf + sqrt(2 p c/EI) with one kf: a bit that drills where it points.
    pub high: f64,
}

/// Bisections of an interval until it has the width of a rounding.
const BISECTIONS: usize = 200;

/// The root of `f` between `low` and `high`, at whose ends its signs differ.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low).signum();
    for _ in 0..BISECTIONS {
        let middle = f64::midpoint(low, high);
        if f(middle).signum() == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// Load across the guide towards the low side (N/m) in a hole of a build curvature (1/m).
fn load(guide: &Guide, weight: f64, sine_of_inclination: f64, curvature: f64) -> f64 {
    weight * curvature + guide.weight_per_metre * sine_of_inclination
}

/// D (1/m) and l (m) of a guide that a load p > 0 presses on the wall.
///
/// At given p the gap is c = EI/p u2 (1/24 - D/(6 u)), and P = eta W_a u/p: one equation for u, which rises with it.
fn free_span(guide: &Guide, law: &BitLaw, load: f64) -> (f64, f64) {
    let steering = law.steering_resistance();
    let held = 1.0 - law.weight / steering;
    let misfit = |u: f64| {
        let inverse = load / (steering * u);
        u * (held / 12.0 - inverse / 2.0) / (held / 2.0 + inverse)
    };
    let stiffness = guide.bending_stiffness / load;
    let gap = |u: f64| stiffness * u * (u / 24.0 - misfit(u) / 6.0) - guide.gap;
    // D/u lies between -1/2 and 1/6, so that c lies between u2/72 and u2/8 times EI/p.
    let u = bisect(
        (8.0 * guide.gap / stiffness).sqrt() * 0.99,
        (72.0 * guide.gap / stiffness).sqrt() * 1.01,
        gap,
    );
    (misfit(u), (u * stiffness).sqrt())
}

/// The curvature kb with kb = kf + `misfit`(p), where p depends on kb.
fn curvature(
    guide: &Guide,
    weight: f64,
    sine_of_inclination: f64,
    misfit: impl Fn(f64) -> f64,
) -> Result<f64, HoleError> {
    let drilled = |kb: f64| {
        let load = load(guide, weight, sine_of_inclination, kb);
        // A load below 0 presses the guide on the high side: the mirrored case.
        let misfit = if load == 0.0 {
            0.0
        } else {
            load.signum() * misfit(load.abs())
        };
        guide.free_curvature + misfit - kb
    };
    let mut reach = 1e-3;
    while drilled(guide.free_curvature - reach) < 0.0 || drilled(guide.free_curvature + reach) > 0.0 {
        reach *= 2.0;
        if reach > 1e3 {
            return Err(HoleError::NoSteadyCurvature { weight });
        }
    }
    Ok(bisect(
        guide.free_curvature - reach,
        guide.free_curvature + reach,
        drilled,
    ))
}

/// A guide in pieces under a load, from the bit to the wall.
struct Span<'a> {
    guide: &'a Guide,
    weight: f64,
    sine_of_inclination: f64,
}

/// A free span that meets the wall.
#[derive(Debug, Clone, Copy)]
struct Met {
    /// kb (1/m).
    curvature: f64,
    /// t (rad).
    tilt: f64,
    /// F (N).
    force: f64,
}

/// Lengths of a free span that are tried, from the bit to the longest one: roots of the equation are some tenths of it apart.
const TRIED: u32 = 400;
/// Share of the length at which thrust alone bends a span without limit: 4 EI/W = l2.
const STABLE: f64 = 0.98;

impl Span<'_> {
    /// With a length (m), and a free curvature k at the wall (1/m). The gap is linear in kb, as p = W kb + q sin(inc) is.
    fn met(&self, length: f64, at_wall: f64) -> Met {
        let (guide, stiffness) = (self.guide, self.guide.bending_stiffness);
        let [first, second] = guide.bends.integrals(guide.free_curvature, length);
        let square = length * length;
        let (per_load, across) = (
            square * square / (24.0 * stiffness),
            guide.weight_per_metre * self.sine_of_inclination,
        );
        let curvature =
            (guide.gap - across * per_load - second + at_wall * square / 3.0) / (self.weight * per_load - square / 6.0);
        let load = self.weight * curvature + across;
        Met {
            curvature,
            tilt: 0.5 * (curvature + at_wall) * length - first - load * length * square / (12.0 * stiffness),
            force: stiffness * (curvature - at_wall) / length + 0.5 * load * length,
        }
    }

    /// kb and l (m) at the shortest free span at which a measure of it rises through 0.
    fn root(&self, measure: impl Fn(Met) -> f64) -> Result<(f64, f64), HoleError> {
        let guide = self.guide;
        let none = HoleError::NoSteadyCurvature { weight: self.weight };
        let longest = guide
            .length
            .min(STABLE * (4.0 * guide.bending_stiffness / self.weight.max(f64::MIN_POSITIVE)).sqrt());
        // Between two of these (l, k) one of both changes: the length within a piece, the curvature at the end of one.
        let mut tried: Vec<[f64; 2]> = Vec::new();
        let changes = guide.bends.changes();
        for step in 1..=TRIED {
            let [before, length] = [step - 1, step].map(|step| longest * f64::from(step) / f64::from(TRIED));
            for change in changes
                .iter()
                .filter(|change| change.from > before && change.from <= length)
            {
                let below = tried.last().map_or(guide.free_curvature, |last| last[1]);
                tried.extend([[change.from, below], [change.from, change.curvature]]);
            }
            tried.push([length, guide.bends.at(guide.free_curvature, length)]);
        }
        let of = |[length, at_wall]: [f64; 2]| measure(self.met(length, at_wall));
        let pair = tried.windows(2).find(|pair| of(pair[0]) < 0.0 && of(pair[1]) >= 0.0);
        let &[low, high] = pair.ok_or_else(|| none.clone())? else {
            return Err(none);
        };
        let between = |share: f64| [0, 1].map(|index| low[index] + share * (high[index] - low[index]));
        let [length, at_wall] = between(bisect(0.0, 1.0, |share| of(between(share))));
        let curvature = self.met(length, at_wall).curvature;
        let load = load(guide, self.weight, self.sine_of_inclination, curvature);
        // A load towards the high side would lay the guide on the other wall.
        if load > 0.0 { Ok((curvature, length)) } else { Err(none) }
    }
}

/// The curvature to which a guide drills with a bit, at an inclination given by its sine, in the plane of the build.
///
/// # Errors
/// [`HoleError::Invalid`] for numbers out of bounds; [`HoleError::NoSteadyCurvature`] if the thrust bends the guide without
/// limit.
pub fn steady(guide: &Guide, law: &BitLaw, sine_of_inclination: f64) -> Result<Steady, HoleError> {
    guide.check()?;
    law.check()?;
    let guide = &guide.under(law.weight);
    let (curvature, free_length) = if guide.bends.is_none() {
        let curvature = curvature(guide, law.weight, sine_of_inclination, |load| {
            free_span(guide, law, load).0
        })?;
        let load = load(guide, law.weight, sine_of_inclination, curvature).abs();
        (curvature, free_span(guide, law, load).1)
    } else {
        let span = Span {
            guide,
            weight: law.weight,
            sine_of_inclination,
        };
        let steering = law.steering_resistance();
        span.root(|met| (1.0 - law.weight / steering) * met.tilt + met.force / steering)?
    };
    Ok(Steady {
        curvature,
        free_length,
        steering_number: law.steering_resistance() * free_length * free_length / guide.bending_stiffness,
    })
}

/// The bounds kf -+ sqrt(2 p c/EI) of the curvature under a weight (N), with p at the bound itself; of a guide in pieces those
/// without side force and without tilt. They need no number of the bit.
///
/// # Errors
/// As [`steady`].
pub fn bounds(guide: &Guide, weight: f64, sine_of_inclination: f64) -> Result<Bounds, HoleError> {
    guide.check()?;
    flexdrill_base::validation::Bound::NotNegative.check("weight", weight, "N")?;
    let guide = &guide.under(weight);
    if !guide.bends.is_none() {
        let span = Span {
            guide,
            weight,
            sine_of_inclination,
        };
        // A bit that a straight piece holds down points below the hole: where it points is then the smaller curvature.
        let (pushed, pointed) = (span.root(|met| met.force)?.0, span.root(|met| met.tilt)?.0);
        return Ok(Bounds {
            low: pushed.min(pointed),
            high: pushed.max(pointed),
        });
    }
    let reach = |load: f64| (2.0 * load * guide.gap / guide.bending_stiffness).sqrt();
    Ok(Bounds {
        low: curvature(guide, weight, sine_of_inclination, |load| -reach(load))?,
        high: curvature(guide, weight, sine_of_inclination, reach)?,
    })
}

/// The steering resistance eta W_a (N) with which a guide of one curvature drills its free curvature: W + sqrt(3 EI p/(2 c)).
/// Above it the hole is more curved than the guide as made.
///
/// # Errors
/// [`HoleError::Invalid`] for numbers out of bounds.
pub fn indifferent_resistance(guide: &Guide, weight: f64, sine_of_inclination: f64) -> Result<f64, HoleError> {
    guide.check()?;
    let guide = &guide.under(weight);
    let load = load(guide, weight, sine_of_inclination, guide.free_curvature).abs();
    Ok(weight + (1.5 * guide.bending_stiffness * load / guide.gap).sqrt())
}
