//! The twin.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::Value;

use flexdrill_config::Config;
use flexdrill_core::inputs::{InputKind, Inputs};
use flexdrill_core::tool::LiveParameters;
use flexdrill_core::units::kn_to_n;

use super::recorder::Recorder;
use super::{arrays, errors};
use crate::twin::{self, InputError, Plan};
use crate::{ahead, saved};

/// Model steps between two looks at signals and progress: a tenth of a second of model time at most.
const STRIDE: u64 = 200;

/// Per input, values in the unit of the rig's samples, each from a number of steps after the beginning on, rising.
pub(super) type Changes = [Vec<(u64, f64)>; InputKind::COUNT];

/// The hole ahead: why nothing is known, why there is no range, radius, build rate, members, arrays.
type HoleAhead<'py> = (
    Option<String>,
    Option<String>,
    f64,
    [f64; 3],
    [usize; 2],
    Bound<'py, PyDict>,
);

/// One run with its configuration.
#[pyclass(module = "flexdrill._native")]
pub(super) struct Twin {
    /// Boxed, because Python aligns its objects to 16 bytes and the vectors in a twin need 64.
    pub(super) inner: Box<twin::Twin>,
}

#[pymethods]
impl Twin {
    /// From the text of a configuration; `overrides` are dotted keys with JSON values.
    #[new]
    fn new(py: Python<'_>, name: &str, text: &str, overrides: Vec<(String, String)>) -> PyResult<Self> {
        let config = Config::from_text(name, text).map_err(|error| errors::config(py, &error))?;
        let values: Vec<(String, Value)> = overrides
            .into_iter()
            .map(|(key, json)| match serde_json::from_str(&json) {
                Ok(value) => Ok((key, value)),
                Err(error) => Err(pyo3::exceptions::PyValueError::new_err(format!(
                    "{key} = {json}: {error}"
                ))),
            })
            .collect::<PyResult<_>>()?;
        let config = if values.is_empty() {
            config
        } else {
            config
                .with_values("override", values)
                .map_err(|error| errors::config(py, &error))?
        };
        let built = py.detach(|| twin::Twin::new(Arc::new(config)));
        Ok(Self {
            inner: Box::new(built.map_err(|error| errors::build(py, &error))?),
        })
    }

    /// The twin in saved bytes.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let restored = py.detach(|| saved::from_bytes(bytes));
        Ok(Self {
            inner: Box::new(restored.map_err(|error| errors::saved(py, &error))?),
        })
    }

    /// The state as bytes.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = saved::to_bytes(&self.inner).map_err(|error| errors::saved(py, &error))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Another twin in the same state.
    fn fork(&self, py: Python<'_>) -> Self {
        let inner = py.detach(|| Box::new(self.inner.fork()));
        Self { inner }
    }

    /// Advances by `steps` model steps without Python's lock. `progress` is called with the steps done, about every tenth
    /// of a second of model time.
    #[pyo3(signature = (steps, changes, recorder=None, progress=None))]
    fn run(
        &mut self,
        py: Python<'_>,
        steps: u64,
        changes: Changes,
        recorder: Option<PyRefMut<'_, Recorder>>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let plan = plan(&self.inner, steps, &changes).map_err(|error| errors::input(py, &error))?;
        let Some(mut keeper) = recorder else {
            return self.follow(py, &plan, None, progress);
        };
        let mut columns = keeper.take()?;
        let result = match columns.check_size(self.inner.sizes(), steps) {
            Ok(()) => self.follow(py, &plan, Some(&mut columns), progress),
            Err(error) => Err(errors::recorder(py, &error)),
        };
        keeper.put(columns);
        result
    }

    /// Adds a sample of the present state to `recorder`; the statistics go on.
    fn look(&self, mut recorder: PyRefMut<'_, Recorder>) -> PyResult<()> {
        let mut columns = recorder.take()?;
        self.inner.look(&mut columns);
        recorder.put(columns);
        Ok(())
    }

    /// Where the tool drills in the next metres under a weight (kN), without Python's lock: why nothing is known, why there
    /// is no range, radius, build rate with its range, members with a result and without, and the arrays.
    fn ahead<'py>(
        &self,
        py: Python<'py>,
        metres: f64,
        members: usize,
        weight_kn: f64,
        seed: u64,
    ) -> PyResult<HoleAhead<'py>> {
        let question = ahead::Question {
            metres,
            members,
            weight: kn_to_n(weight_kn),
            seed,
        };
        let answer = py
            .detach(|| ahead::answer(self.inner.config(), &question))
            .map_err(|error| errors::value(py, error.to_string()))?;
        let columns = arrays::dictionary(py, answer.columns)?;
        Ok((
            answer.because,
            answer.no_range,
            answer.radius,
            answer.build_rate,
            answer.members,
            columns,
        ))
    }

    /// Resets the motion to the state after the start.
    fn reset(&mut self) {
        self.inner.reset();
    }

    /// Disturbs the lateral motion of the pipe.
    fn disturb(&mut self, seed: u64) {
        self.inner.disturb(seed);
    }

    /// Friction of pipe and guide (around, along), of guide and wall, and the bit's friction factor.
    #[getter]
    fn live(&self) -> ([f64; 2], [f64; 2], f64) {
        let live = self.inner.simulation().live();
        (live.inner_friction, live.outer_friction, live.bit_friction_factor)
    }

    /// Replaces them from the next step on.
    fn set_live(
        &mut self,
        py: Python<'_>,
        inner_friction: [f64; 2],
        outer_friction: [f64; 2],
        bit_friction_factor: f64,
    ) -> PyResult<()> {
        let live = LiveParameters {
            inner_friction,
            outer_friction,
            bit_friction_factor,
        };
        self.inner
            .set_live(live)
            .map_err(|error| errors::value(py, error.to_string()))
    }

    /// Model time (s).
    #[getter]
    fn time_s(&self) -> f64 {
        self.inner.simulation().time()
    }

    /// Model steps taken.
    #[getter]
    fn step(&self) -> u64 {
        self.inner.simulation().step()
    }

    /// Model step (s).
    #[getter]
    fn time_step_s(&self) -> f64 {
        self.inner.simulation().settings().time_step
    }

    /// Targets that act now, in the units of the rig's samples.
    #[getter]
    fn inputs(&self) -> [f64; InputKind::COUNT] {
        let inputs = self.inner.inputs();
        InputKind::ALL.map(|kind| kind.from_si(inputs.get(kind)))
    }

    /// Smallest and largest value of each input, in the units of the rig's samples.
    #[getter]
    fn input_limits(&self) -> [[f64; 2]; InputKind::COUNT] {
        let config = self.inner.config();
        config
            .inputs
            .rules_of(config.used_inputs())
            .map(|rule| [rule.min, rule.max])
    }

    /// Stations of the joints.
    #[getter]
    fn joint_stations(&self) -> Vec<usize> {
        self.inner.simulation().joint_stations().to_vec()
    }

    /// Mass of the tool (kg).
    #[getter]
    fn mass_kg(&self) -> f64 {
        self.inner.simulation().mass()
    }

    /// The complete configuration as JSON.
    #[getter]
    fn configuration(&self) -> String {
        self.inner.config().to_tree().to_string()
    }

    /// Its SHA-256.
    #[getter]
    fn configuration_hash(&self) -> String {
        self.inner.config().hash()
    }
}

impl Twin {
    fn follow(
        &mut self,
        py: Python<'_>,
        plan: &Plan,
        mut columns: Option<&mut crate::Recorder>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let mut done = 0;
        while done < plan.steps {
            let inner = &mut self.inner;
            let recorder = columns.as_deref_mut();
            let advanced = py.detach(|| inner.follow(plan, done, STRIDE, recorder));
            done = advanced.map_err(|failure| errors::step(py, &failure))?;
            py.check_signals()?;
            if let Some(progress) = &progress {
                progress.call1((done,))?;
            }
        }
        Ok(())
    }
}

/// The inputs of a run of `steps` from the twin's present state, checked against the limits of its configuration.
pub(super) fn plan(twin: &twin::Twin, steps: u64, changes: &Changes) -> Result<Plan, InputError> {
    let (begun, time_step) = (twin.simulation().time(), twin.simulation().settings().time_step);
    let mut merged = std::collections::BTreeMap::new();
    for (kind, values) in InputKind::ALL.into_iter().zip(changes) {
        for (step, value) in values {
            let si = twin.checked(kind, *value, begun + *step as f64 * time_step)?;
            merged.entry(*step).or_insert([None; InputKind::COUNT])[kind.index()] = Some(si);
        }
    }
    let mut now = twin.inputs();
    let changes = merged
        .into_iter()
        .map(|(step, values)| {
            let get = |kind: InputKind| values[kind.index()].unwrap_or(now.get(kind));
            now = Inputs {
                rotary_speed: get(InputKind::RotarySpeed),
                weight_on_bit: get(InputKind::WeightOnBit),
                rate_of_penetration: get(InputKind::RateOfPenetration),
                standpipe_pressure: get(InputKind::StandpipePressure),
            };
            (step, now)
        })
        .collect();
    Ok(Plan { steps, changes })
}
