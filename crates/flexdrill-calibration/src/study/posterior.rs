//! What was found as a sample: the value of each key in each member of the posterior.

use super::unknowns::Unknowns;
use crate::fit::Outcome;
use crate::identify::Verdict;
use crate::unknown::Unknown;
use flexdrill_config::NumberKey;
use nalgebra::DVector;

/// A sample of the posterior in the units of the configuration's keys. All members have the same weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Dotted paths of the keys that the log determines, alone or in combination.
    pub keys: Vec<&'static str>,
    /// The values of each member, by key.
    pub members: Vec<Vec<f64>>,
    /// Members that are left out because a value is beyond the limits of its key, which no tool can have.
    pub beyond_limits: usize,
}

/// Correlation with an unknown that the log determines, from which on an unknown is in the sample: more than 1000 members show
/// by chance (0.03), and enough that a draw from its prior would contradict them.
const DEPENDS: f64 = 0.25;

/// A key that gets a value of an unknown.
struct Column<'a> {
    key: &'static str,
    unknown: &'a Unknown,
    index: usize,
    /// Units of the key per SI unit, or what the key gets per value.
    factor: f64,
}

/// Whether each unknown is in the sample: it is determined, alone or in combination, or depends on one that is.
fn in_the_sample(outcome: &Outcome) -> Vec<bool> {
    let determined = |index: usize| {
        let alone = outcome.estimates[index].verdict != Verdict::NotIdentifiable;
        alone || outcome.pairs.iter().any(|pair| pair.unknowns.contains(&index))
    };
    let posterior = &outcome.posterior;
    let from: Vec<DVector<f64>> = posterior
        .row_iter()
        .map(|row| {
            let middle = row.mean();
            row.transpose().map(|value| value - middle)
        })
        .collect();
    let alike = |a: usize, b: usize| {
        let size = from[a].norm() * from[b].norm();
        if size > 0.0 {
            from[a].dot(&from[b]).abs() / size
        } else {
            0.0
        }
    };
    (0..outcome.estimates.len())
        .map(|index| {
            let others = (0..outcome.estimates.len()).filter(|other| determined(*other));
            determined(index) || others.into_iter().any(|other| alike(index, other) > DEPENDS)
        })
        .collect()
}

/// The sample of an outcome. An unknown that the log does not determine is left out: its members are noise about its prior,
/// which the prior has without noise. One on which others depend is in it, as only their joint sample has what the log says
/// of them.
pub fn sample(numbers: &[NumberKey], unknowns: &Unknowns, outcome: &Outcome) -> Sampled {
    let mut columns = Vec::new();
    for (index, modelled) in unknowns.modelled.iter().enumerate() {
        columns.extend(modelled.keys.iter().map(|key| Column {
            key,
            unknown: &modelled.unknown,
            index,
            factor: modelled.per_value,
        }));
    }
    // Those of the sensors follow the modelled unknowns, in this order.
    for (after, known) in unknowns.sensors.iter().enumerate() {
        columns.extend(known.key.map(|key| Column {
            key,
            unknown: &known.unknown,
            index: unknowns.modelled.len() + after,
            factor: known.per_value,
        }));
    }
    let known = in_the_sample(outcome);
    columns.retain(|column| known[column.index]);
    let limits: Vec<Option<&NumberKey>> = columns
        .iter()
        .map(|column| numbers.iter().find(|number| number.key == column.key))
        .collect();
    let all = outcome.posterior.column_iter().map(|member| -> Vec<f64> {
        let value = |column: &Column| column.factor * column.unknown.value(member[column.index]);
        columns.iter().map(value).collect()
    });
    let is_within = |values: &Vec<f64>| {
        let mut both = limits.iter().zip(values);
        both.all(|(limit, value)| limit.is_none_or(|limit| limit.bound().holds(*value)))
    };
    let members: Vec<Vec<f64>> = all.filter(is_within).collect();
    Sampled {
        keys: columns.iter().map(|column| column.key).collect(),
        beyond_limits: outcome.posterior.ncols() - members.len(),
        members,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::identify;
    use flexdrill_config::Config;
    use nalgebra::DMatrix;

    #[test]
    fn members_have_what_the_log_determines_in_the_units_of_the_keys() {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        let unknowns = Unknowns::of(&config).unwrap();
        let all: Vec<Unknown> = unknowns.all();
        let [inner, wall, bit] = [0, 1, 2];
        let place = |name: &str| all.iter().position(|unknown| unknown.name == name).unwrap();
        let (joints, hook) = (place("friction in the joints"), place("tare of the hook load"));
        let (force, weight) = (
            place("force that the wear flats carry"),
            place("factor of the weight indicator"),
        );
        // The pipe's and the wall's have a known sum, the bit's is known and the hook load's tare is. That of the joints and all
        // others are as before; the wear flats' force is, too, but depends on the bit's friction.
        let wave = |k: usize, turns: usize, phase: f64| {
            2.0_f64.sqrt() * (std::f64::consts::TAU * (turns as f64 * k as f64 / 80.0 + phase)).sin()
        };
        let posterior = DMatrix::from_fn(all.len(), 80, |row, k| match row {
            _ if row == inner => 0.7 * wave(k, 1, 0.0),
            _ if row == wall => -0.7 * wave(k, 1, 0.0),
            _ if row == bit => 0.5 + 0.02 * wave(k, 2, 0.0),
            _ if row == force => 0.94 * wave(k, 2, 0.0) + 0.34 * wave(k, 2, 0.25),
            // One member has pins of a friction above 1, the limit of the key.
            _ if row == joints && k == 7 => 9.0,
            _ if row == hook => -0.1 * wave(k, 3, 0.0),
            _ if row == weight => 0.5 * wave(k, 4, 0.0),
            _ => wave(k, 5 + row, 0.0),
        });
        let (estimates, pairs) = identify(&all, &posterior);
        let outcome = Outcome {
            estimates,
            pairs,
            explained: Vec::new(),
            checks: Vec::new(),
            misfit: 1.0,
            posterior: posterior.clone(),
        };
        let found = sample(&config.numbers(), &unknowns, &outcome);
        assert_eq!(
            found.keys,
            [
                "contact.inner.friction_tangential",
                "contact.inner.friction_axial",
                "contact.outer.friction_tangential",
                "contact.outer.friction_axial",
                "rock.depth_of_cut.wear_flat_friction",
                "rock.depth_of_cut.wear_flat_force",
                "calibration.hook_load_tare_kn",
                "uncertainty.sensors.weight_indicator.factor",
            ]
        );
        // The joints are not in the sample, so that no member is beyond a limit.
        assert_eq!((found.members.len(), found.beyond_limits), (80, 0));
        for (member, z) in found.members.iter().zip(posterior.column_iter()) {
            assert_eq!(member[0], all[inner].value(z[inner]));
            assert_eq!(member[3], member[2]);
            assert!((member[6] - 1e-3 * all[hook].value(z[hook])).abs() < 1e-12);
            assert_eq!(member[7], all[weight].value(z[weight]));
        }
        let mut far = outcome;
        far.posterior[(bit, 3)] = 1e3;
        assert_eq!(sample(&config.numbers(), &unknowns, &far).beyond_limits, 1);
    }
}
