//! What was found as a sample: the value of each key in each member of the posterior.

use super::unknowns::Unknowns;
use crate::fit::Outcome;
use crate::identify::Verdict;
use crate::unknown::Unknown;
use flexdrill_config::NumberKey;
use flexdrill_core::units::n_to_kn;

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

/// A key that gets a value of an unknown.
struct Column<'a> {
    key: &'static str,
    unknown: &'a Unknown,
    index: usize,
    /// Units of the key per SI unit, or what the key gets per value.
    factor: f64,
}

/// The sample of an outcome. An unknown that the log does not determine is left out: its members are noise about its prior,
/// which the prior has without noise. Unknowns of a pair are in it, as only their joint sample has what the log says of them.
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
    // The tares follow the modelled unknowns, in this order.
    let tares = [
        ("calibration.torque_tare_nm", &unknowns.torque_tare, 1.0),
        ("calibration.hook_load_tare_kn", &unknowns.hook_load_tare, n_to_kn(1.0)),
    ];
    for (after, (key, unknown, factor)) in tares.into_iter().enumerate() {
        let index = unknowns.modelled.len() + after;
        columns.push(Column {
            key,
            unknown,
            index,
            factor,
        });
    }
    columns.retain(|column| {
        let alone = outcome.estimates.get(column.index);
        let alone = alone.is_some_and(|estimate| estimate.verdict != Verdict::NotIdentifiable);
        alone || outcome.pairs.iter().any(|pair| pair.unknowns.contains(&column.index))
    });
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
        let mut all: Vec<Unknown> = unknowns.modelled.iter().map(|of| of.unknown.clone()).collect();
        all.extend([unknowns.torque_tare.clone(), unknowns.hook_load_tare.clone()]);
        // Pipe in guide, wall, bit, joints, two tares. The pipe's and the wall's have a known sum, the bit's is known, that of
        // the joints and the torque's tare are as before, and the hook load's tare is known.
        let wave = |k: usize, phase: f64| 2.0_f64.sqrt() * (std::f64::consts::TAU * (k as f64 / 40.0 + phase)).sin();
        let posterior = DMatrix::from_fn(6, 40, |row, k| match row {
            0 => 0.7 * wave(k, 0.0),
            1 => -0.7 * wave(k, 0.0),
            2 => 0.5 + 0.02 * wave(k, 0.2),
            // One member has pins of a friction above 1, the limit of the key.
            3 if k == 7 => 9.0,
            3 | 4 => wave(k, 0.3),
            _ => -0.1 * wave(k, 0.4),
        });
        let (estimates, pairs) = identify(&all, &posterior);
        let outcome = Outcome {
            estimates,
            pairs,
            explained: Vec::new(),
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
                "calibration.hook_load_tare_kn",
            ]
        );
        // The joints are not in the sample, so that no member is beyond a limit.
        assert_eq!((found.members.len(), found.beyond_limits), (40, 0));
        for (member, z) in found.members.iter().zip(posterior.column_iter()) {
            assert_eq!(member[0], all[0].value(z[0]));
            assert_eq!(member[3], member[2]);
            assert!((member[5] - 1e-3 * all[5].value(z[5])).abs() < 1e-12);
        }
        let mut far = outcome;
        far.posterior[(2, 3)] = 1e3;
        assert_eq!(sample(&config.numbers(), &unknowns, &far).beyond_limits, 1);
    }
}
