//! The values of a sweep's points: grids, lists and Latin hypercubes as rows.

use flexdrill_config::Config;
use serde_json::{Map, Value};

use crate::plan::MOST_POINTS;
use crate::spec::{LatinHypercube, Spec};

impl Spec {
    /// Keys and rows of values.
    pub(crate) fn rows(&self, config: &Config) -> (Vec<String>, Vec<Vec<Value>>) {
        if let Some(cube) = &self.latin_hypercube {
            return (cube.ranges.keys().cloned().collect(), cube.rows(config));
        }
        if let Some(first) = self.list.first() {
            let keys: Vec<String> = first.keys().cloned().collect();
            let row = |point: &Map<String, Value>| keys.iter().filter_map(|key| point.get(key).cloned()).collect();
            let rows = self.list.iter().map(row).collect();
            return (keys, rows);
        }
        let mut rows: Vec<Vec<Value>> = vec![Vec::new()];
        for values in self.grid.values() {
            let values = along(values).unwrap_or_default();
            rows = rows
                .iter()
                .flat_map(|row: &Vec<Value>| {
                    values
                        .iter()
                        .map(|value| [row.as_slice(), std::slice::from_ref(value)].concat())
                })
                .collect();
        }
        (self.grid.keys().cloned().collect(), rows)
    }
}

impl LatinHypercube {
    fn rows(&self, config: &Config) -> Vec<Vec<Value>> {
        let tree = config.to_tree();
        let mut random = fastrand::Rng::with_seed(self.seed);
        let columns: Vec<Vec<Value>> = self
            .ranges
            .iter()
            .filter_map(|(key, range)| {
                let [low, high] = ends(range)?;
                let is_whole = tree
                    .pointer(&format!("/{}", key.replace('.', "/")))
                    .is_some_and(Value::is_u64);
                let mut parts: Vec<usize> = (0..self.points).collect();
                random.shuffle(&mut parts);
                let value = |part: usize, random: &mut fastrand::Rng| {
                    let value = low + (high - low) * (part as f64 + random.f64()) / self.points as f64;
                    if is_whole {
                        Value::from(value.round() as u64)
                    } else {
                        Value::from(value)
                    }
                };
                Some(parts.into_iter().map(|part| value(part, &mut random)).collect())
            })
            .collect();
        (0..self.points)
            .map(|point| columns.iter().map(|column| column[point].clone()).collect())
            .collect()
    }
}

/// Whether a point can have it.
pub(crate) fn is_scalar(value: &Value) -> bool {
    matches!(value, Value::Number(_) | Value::String(_) | Value::Bool(_))
}

/// The bounds of a range, rising.
pub(crate) fn ends(range: &Value) -> Option<[f64; 2]> {
    let [low, high] = range.as_array()?.as_slice() else {
        return None;
    };
    let (low, high) = (low.as_f64()?, high.as_f64()?);
    (low < high && high - low < f64::INFINITY).then_some([low, high])
}

/// The values of a grid along one key.
pub(crate) fn along(values: &Value) -> Result<Vec<Value>, &'static str> {
    if let Value::Array(list) = values {
        return if list.is_empty() || !list.iter().all(is_scalar) {
            Err("a list of at least one number, word, true or false")
        } else {
            Ok(list.clone())
        };
    }
    let table = values.as_object().ok_or("a list or a range")?;
    if table.keys().any(|key| !["from", "to", "count"].contains(&key.as_str())) {
        return Err("of `from`, `to` and `count` only");
    }
    let [from, to] = ["from", "to"].map(|key| table.get(key).and_then(Value::as_f64));
    let (Some(from), Some(to)) = (from, to) else {
        return Err("with `from` and `to`, both numbers");
    };
    let count = table.get("count").and_then(Value::as_u64).unwrap_or(0);
    let rises = from < to && to - from < f64::INFINITY;
    if !rises || !(2..=MOST_POINTS as u64).contains(&count) {
        return Err("from a smaller to a larger number, with a `count` of 2 to 200000");
    }
    Ok(evenly(from, to, count as usize).into_iter().map(Value::from).collect())
}

/// `count` values from `from` to `to`, both ends included.
pub fn evenly(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1);
    // Ends as given: rounding must not bring them out of bounds.
    (0..count)
        .map(|at| match at {
            0 => from,
            at if at == last => to,
            at => from + (to - from) * at as f64 / last as f64,
        })
        .collect()
}
