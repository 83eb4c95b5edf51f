//! The hole ahead of a configuration: where its tool drills in the next metres, with the range of plausible tools.

use flexdrill_config::Config;
use flexdrill_drilling::{
    Band, Drilling, Refusal, SPACING, Spread, Station, Track, across, build, drill, middle_inclination, spread,
    unknowns,
};
use flexdrill_hole::{HoleError, steady};

use crate::recorder::{Finished, Values};

/// Farthest end (m): the statics of 100 m take minutes.
pub const MOST_METRES: f64 = 100.0;
/// Most plausible tools.
pub const MOST_MEMBERS: usize = 10_000;
/// Stations of the next metre.
const NEXT_METRE: usize = (1.0 / SPACING) as usize;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// Length ahead (m).
    pub metres: f64,
    /// Plausible tools.
    pub members: usize,
    /// Weight at the bit (N).
    pub weight: f64,
    /// Seed of their draws.
    pub seed: u64,
}

/// Why a question is none.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum QuestionError {
    /// Too near or too far.
    #[error("metres = {0}: must be {SPACING} to {MOST_METRES} m")]
    Metres(f64),
    /// Too many plausible tools.
    #[error("members = {0}: must be at most {MOST_MEMBERS}")]
    Members(usize),
}

/// The answer.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Why nothing is known; none where something is.
    pub because: Option<String>,
    /// Why there is no range; none where there is one.
    pub no_range: Option<String>,
    /// Radius that the tool drills to in a long arc (m).
    pub radius: f64,
    /// Turn of the inclination over the next metre (rad/m): of the tool as configured, and 5 and 95 % of plausible tools.
    pub build_rate: [f64; 3],
    /// Plausible tools with a result, and without.
    pub members: [usize; 2],
    /// Arrays over the stations, the first at the bit.
    pub columns: Vec<Finished>,
}

/// Where the tool of a configuration drills. What cannot be predicted is part of the answer.
///
/// # Errors
/// When the question is out of bounds.
pub fn answer(config: &Config, question: &Question) -> Result<Answer, QuestionError> {
    let Question { metres, members, .. } = *question;
    if !(SPACING..=MOST_METRES).contains(&metres) {
        return Err(QuestionError::Metres(metres));
    }
    if members > MOST_MEMBERS {
        return Err(QuestionError::Members(members));
    }
    Ok(computed(config, question).unwrap_or_else(|because| Answer {
        because: Some(because),
        no_range: None,
        radius: f64::NAN,
        build_rate: [f64::NAN; 3],
        members: [0, 0],
        columns: columns(config, &[], &[]),
    }))
}

/// The answer, or why there is none.
fn computed(config: &Config, question: &Question) -> Result<Answer, String> {
    let refused = |error: Refusal| error.to_string();
    let unsolved = |error: HoleError| format!("the tool as configured: {error}");
    let stations = (question.metres / SPACING).round() as usize;
    let drilling = Drilling::of(config, question.weight, 0.0).map_err(refused)?;
    let track = drill(&drilling, stations).map_err(unsolved)?;
    let tools = unknowns::members(config, question.weight, 0.0, question.members, question.seed)
        .map_err(|error| error.to_string())?;
    let run = |tool: Result<Drilling, String>| tool.and_then(|tool| drill(&tool, stations).map_err(|e| e.to_string()));
    let members: Vec<Result<Track, String>> = tools.into_iter().map(run).collect();
    let known = members.iter().flatten().count();
    // The rate is that of the next metre, as a driller asks for it, or of the whole way where that is shorter.
    let next = NEXT_METRE.min(stations);
    let rates = Band::of(members.iter().flatten().map(|track| build(track, next)).collect());
    let [low, high] = rates.map_or([f64::NAN; 2], |rates| [rates.low, rates.high]);
    let sine = libm::sin(middle_inclination(&track));
    // In a hole that the thrust bends without limit there is no long arc.
    let radius = steady(&drilling.guide, &drilling.law, sine).map_or(f64::NAN, |steady| 1.0 / steady.curvature);
    let no_range = (known < Band::LEAST).then(|| {
        format!(
            "{known} plausible tools have a result: a range needs {} of them",
            Band::LEAST
        )
    });
    Ok(Answer {
        because: None,
        no_range,
        radius,
        build_rate: [build(&track, next), low, high],
        members: [known, members.len() - known],
        columns: columns(config, &track, &spread(&track, &members)),
    })
}

/// The arrays; ranges are NaN without plausible tools.
fn columns(config: &Config, track: &[Station], spread: &[Spread]) -> Vec<Finished> {
    let column = |name: &str, values: Vec<f64>, components: usize| Finished {
        name: name.to_owned(),
        shape: if components == 1 {
            vec![track.len()]
        } else {
            vec![track.len(), components]
        },
        values: Values::Real(values),
    };
    let of = |number: &dyn Fn(usize, &Station) -> f64| -> Vec<f64> {
        track
            .iter()
            .enumerate()
            .map(|(at, station)| number(at, station))
            .collect()
    };
    let ranged = |end: &dyn Fn(&Spread) -> f64| of(&|at, _| spread.get(at).map_or(f64::NAN, end));
    let bit = config.well.length();
    // Ends of the range across the hole, from the nominal position along the unit vectors at the station.
    let across_end = |high: bool, upper: bool| -> Vec<f64> {
        let point = |(at, station): (usize, &Station)| {
            let [to_high, to_right] = across(station);
            let (band, unit) = match (high, spread.get(at)) {
                (_, None) => (None, to_high),
                (true, Some(spread)) => (Some(spread.high), to_high),
                (false, Some(spread)) => (Some(spread.right), to_right),
            };
            let offset = band.map_or(f64::NAN, |band| if upper { band.high } else { band.low });
            [0, 1, 2].map(|axis| station.position[axis] + offset * unit[axis])
        };
        track.iter().enumerate().flat_map(point).collect()
    };
    vec![
        column("measured_depth_m", of(&|at, _| bit + at as f64 * SPACING), 1),
        column("inclination_rad", of(&|_, station| station.inclination), 1),
        column("inclination_low_rad", ranged(&|spread| spread.inclination.low), 1),
        column("inclination_high_rad", ranged(&|spread| spread.inclination.high), 1),
        column("azimuth_rad", of(&|_, station| station.azimuth), 1),
        column("azimuth_low_rad", ranged(&|spread| spread.azimuth.low), 1),
        column("azimuth_high_rad", ranged(&|spread| spread.azimuth.high), 1),
        column(
            "position_m",
            track.iter().flat_map(|station| station.position).collect(),
            3,
        ),
        column("upper_m", across_end(true, true), 3),
        column("lower_m", across_end(true, false), 3),
        column("right_m", across_end(false, true), 3),
        column("left_m", across_end(false, false), 3),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(more: &str) -> Config {
        let text = include_str!("../../../tests/data/ahead.yaml");
        Config::from_text("ahead.yaml", &format!("{text}{more}")).unwrap()
    }

    fn values(answer: &Answer, name: &str) -> Vec<f64> {
        match &answer.columns.iter().find(|column| column.name == name).unwrap().values {
            Values::Real(values) => values.clone(),
            _ => panic!("{name}"),
        }
    }

    const QUESTION: Question = Question {
        metres: 1.0,
        members: 19,
        weight: 10e3,
        seed: 1,
    };

    #[test]
    fn ranges_lie_around_the_tool_as_configured() {
        let answered = answer(&config(""), &QUESTION).unwrap();
        assert_eq!((answered.because.as_deref(), answered.members), (None, [19, 0]));
        let depth = values(&answered, "measured_depth_m");
        let [inclination, low, high] =
            ["inclination_rad", "inclination_low_rad", "inclination_high_rad"].map(|name| values(&answered, name));
        assert_eq!(depth.len(), 5);
        assert!((depth[4] - depth[0] - 1.0).abs() < 1e-12);
        for at in 1..5 {
            assert!(
                low[at] < inclination[at] && inclination[at] < high[at],
                "{at}: {low:?} {inclination:?} {high:?}"
            );
        }
        // The build rate is what the inclinations say.
        let [rate, low, high] = answered.build_rate;
        assert!((rate - (inclination[4] - inclination[0])).abs() < 1e-12 && low < rate && rate < high);
        // Guide and hole have a radius of 3.2 m.
        assert!((2.0..6.0).contains(&answered.radius), "{}", answered.radius);
    }

    #[test]
    fn few_tools_have_no_range_and_a_straight_hole_no_answer() {
        let few = answer(&config(""), &Question { members: 3, ..QUESTION }).unwrap();
        assert!(few.because.is_none() && few.no_range.is_some(), "{few:?}");
        assert!(values(&few, "azimuth_low_rad").iter().all(|value| value.is_nan()));
        let refused = answer(
            &config(""),
            &Question {
                weight: 0.0,
                ..QUESTION
            },
        )
        .unwrap();
        assert!(
            refused.because.is_some() && values(&refused, "position_m").is_empty(),
            "{refused:?}"
        );
        assert_eq!(
            answer(
                &config(""),
                &Question {
                    metres: 0.0,
                    ..QUESTION
                }
            )
            .map(|_| ()),
            Err(QuestionError::Metres(0.0))
        );
    }
}
