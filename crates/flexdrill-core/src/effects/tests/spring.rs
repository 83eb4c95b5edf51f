//! An effect that only tests have: springs along the axis between pipe and guide at every station but the first. It shows what
//! an effect costs, which is this file and a line in the list, and holds the chain against closed forms.
//!
//! ```text
//! F = k (u_pipe - u_guide),      U = k (u_pipe - u_guide)^2 / 2
//! ```

use std::cell::Cell;

use crate::chain::columns::{EndColumn, at_ends};
use crate::chain::{Additions, Chain, Effect, Precision, Under, row};
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

thread_local! {
    /// Stiffness k of each spring (N/m) of the tools that this thread builds; 0 where they have none.
    static STIFFNESS: Cell<f64> = const { Cell::new(0.0) };
}

#[derive(Clone)]
pub(crate) struct Springs {
    stiffness: f64,
    /// How far each spring is stretched (m), by span and station.
    stretched: Vec<[f64; 8]>,
}

impl Springs {
    pub(crate) fn of(_model: &Model, chain: &Chain) -> Option<Self> {
        let stiffness = STIFFNESS.get();
        (stiffness > 0.0).then(|| Self {
            stiffness,
            stretched: vec![[0.0; 8]; chain.spans()],
        })
    }
}

/// A station's motion along its axis by the ends of its span: the transpose of what a force there does to them.
fn along(rows: &EndColumn, nodes: &[[f64; 16]], l: usize, body: usize) -> f64 {
    let ends = at_ends(nodes, l, body);
    let by_end = ends.as_flattened().iter().enumerate();
    by_end.map(|(k, x)| rows[row(k)] * x).sum()
}

impl Effect for Springs {
    fn force(&mut self, chain: &mut Chain, state: &mut State, _under: &Under<'_>) {
        let (nodes, _) = state.q.as_chunks();
        for (l, stretched) in self.stretched.iter_mut().enumerate() {
            if !chain.is_active(l) {
                continue;
            }
            for i in 1..=chain.stations_below(l).len() {
                let rows = [0, 1].map(|body| chain.model.kind(l).force[i][body][0]);
                let stretch = along(&rows[0], nodes, l, 0) - along(&rows[1], nodes, l, 1);
                stretched[i - 1] = stretch;
                for (body, sign) in [(0, 1.0), (1, -1.0)] {
                    let to = &mut chain.inside(l)[body];
                    to.iter_mut()
                        .zip(&rows[body])
                        .for_each(|(to, row)| *to += sign * self.stiffness * stretch * row);
                }
            }
        }
    }

    fn tangent<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, _state: &State, at: &Iteration<'_>) {
        chain.model.instructions.run(Tangents {
            to,
            chain,
            stiffness: self.stiffness * at.factors.stiffness,
        });
    }

    fn energy(&self, _chain: &Chain, _point: &mut LedgerPoint, _state: &State, _under: &Under<'_>) -> f64 {
        let squares = self.stretched.as_flattened().iter().map(|stretch| stretch * stretch);
        0.5 * self.stiffness * squares.sum::<f64>()
    }
}

struct Tangents<'a, S> {
    to: &'a mut Additions<S>,
    chain: &'a Chain,
    stiffness: f64,
}

impl<S: Precision> Kernel for Tangents<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let chain = self.chain;
        for l in (0..chain.spans()).filter(|&l| chain.is_active(l)) {
            for i in 1..=chain.stations_below(l).len() {
                let along_only = [[self.stiffness, 0.0], [0.0, 0.0]];
                self.to.add_local::<V>(&chain.model, (l, i), true, [0, 1], &along_only);
            }
        }
    }
}

mod tests {
    use super::*;
    use crate::Instructions;
    use crate::dynamics::scheme::Scheme;
    use crate::dynamics::tolerances::Tolerances;
    use crate::inputs::Inputs;
    use crate::step::{Forcing, SolverKind, Stepper, StepperSettings};
    use crate::support::figure;
    use crate::tool::{Body, Direction, LoadHistory, Location, PointLoad, ToolDescription, WellSection};

    const LINKS: usize = 8;
    /// Force on the pipe's lower end (N).
    const LOAD: f64 = 2e4;

    /// A pipe in a straight well without gravity, one element per link, in a guide that is held; loaded along the axis.
    fn loaded() -> ToolDescription {
        ToolDescription::paper().with_mesh(LINKS, 1).with(|tool| {
            tool.well.sections = vec![WellSection::Straight { length: 4.0 }];
            (tool.gravity, tool.guide_fixed) = (0.0, true);
            tool.loads = vec![PointLoad {
                location: Location::Bottom,
                body: Body::Pipe,
                direction: Direction::U,
                history: LoadHistory::Constant(LOAD),
            }];
        })
    }

    fn stepper(tool: &ToolDescription, solver: SolverKind) -> Stepper {
        let settings = StepperSettings {
            time_step: 2.5e-4,
            scheme: Scheme::newmark(0.6),
            tolerances: Tolerances::default(),
            max_halvings: 6,
            solver,
            instructions: Instructions::best(),
        };
        Stepper::new(tool, &settings).unwrap()
    }

    /// A chain of equal bars, s = E A / l, each lower end on a spring k: u_j = A sinh(j t) with 2 cosh(t) = 2 + k / s, and
    /// A from the force at the lower end. Energy by Clapeyron's theorem, F u / 2. Tolerances: the corrections at rest end at
    /// rounding, 1e-8 of displacements of micrometres; steps end at the limits of their residual, 1e-7.
    #[test]
    fn analytic_bars_on_springs() {
        let tool = loaded();
        for (stiffness, solver, over) in [
            (2e7, SolverKind::Chain, "chain"),
            (1e9, SolverKind::Chain, "chain"),
            (2e7, SolverKind::Stations, "all stations"),
        ] {
            STIFFNESS.set(stiffness);
            let mut stepper = stepper(&tool, solver);
            let state = stepper.settle(&Inputs::ZERO).unwrap();
            let model = stepper.model();
            let beam = &model.pipe[0].beam;
            let s = beam.section.axial / beam.length;
            let t = (1.0 + 0.5 * stiffness / s).acosh();
            let sinh = |j: usize| (j as f64 * t).sinh();
            let a = LOAD / (s * (sinh(LINKS) - sinh(LINKS - 1)) + stiffness * sinh(LINKS));
            for j in 1..=LINKS {
                let u = state.q[model.stations[j].pipe_above];
                figure(
                    &format!("{over}, k = {stiffness:e} N/m: station {j} (m)"),
                    a * sinh(j),
                    u,
                    1e-8,
                );
            }
            let stored = 0.5 * LOAD * a * sinh(LINKS);
            let quantity = format!("{over}, k = {stiffness:e} N/m: stored (J)");
            figure(&quantity, stored, stepper.stored_energy(), 1e-8);

            // A step of the tool at rest leaves it there, and costs no energy.
            let still = Forcing::between(&Inputs::ZERO, &Inputs::ZERO);
            for _ in 0..20 {
                assert!(stepper.advance(2.5e-4, &still).ok().is_ok());
            }
            let u = stepper.state().q[stepper.model().stations[LINKS].pipe_above];
            let quantity = format!("{over}, k = {stiffness:e} N/m: lower end after 20 steps (m)");
            figure(&quantity, a * sinh(LINKS), u, 1e-7);
            STIFFNESS.set(0.0);
        }
    }

    /// Without the springs the bars carry the whole load: u = F L / (E A).
    #[test]
    fn a_tool_without_the_effect_has_none_of_it() {
        let tool = loaded();
        let mut stepper = stepper(&tool, SolverKind::Chain);
        let state = stepper.settle(&Inputs::ZERO).unwrap();
        let model = stepper.model();
        let beam = &model.pipe[0].beam;
        let u = LOAD * LINKS as f64 * beam.length / beam.section.axial;
        figure("lower end (m)", u, state.q[model.stations[LINKS].pipe_above], 1e-8);
    }
}
