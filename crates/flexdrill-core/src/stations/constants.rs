//! What the assembly over all stations reads in addition to the model: its elements one by one, and constant forces.

use nalgebra::Vector3;

use crate::dynamics::numbered::Numbered;
use crate::effects::mud::{Lateral, Mud, MudLump};
use crate::effects::preload::{self, Preload};
use crate::effects::pressure::PipePressure;
use crate::elements::beam::ElementMatrix;
use crate::model::Model;

/// An element of pipe or guide, its matrices along the axes of its nodes.
#[derive(Clone)]
pub(crate) struct PlainElement {
    pub stiffness: ElementMatrix,
    pub mass: ElementMatrix,
    /// Geometric stiffness per tension.
    pub geometric: ElementMatrix,
    /// First unknowns of the nodes.
    pub nodes: [usize; 2],
}

/// Constant parts of the equations over all stations.
#[derive(Clone)]
pub(crate) struct Constants {
    /// Elements, pipe then guide, from the top down.
    pub elements: Vec<PlainElement>,
    /// Couples of the guide's preload, per unknown (N m).
    pub preload: Vec<f64>,
    /// The pressure in the pipe, with its forces on pipe and mud, per unknown and per pressure at the top (N/Pa).
    pub pressure: Option<(PipePressure, Vec<f64>)>,
}

impl Constants {
    /// Of `model`.
    pub fn of(model: &Model) -> Self {
        let ends = model.stations.windows(2);
        let pipe = ends.clone().zip(&model.pipe).map(|(ends, element)| PlainElement {
            stiffness: element.beam.stiffness(),
            mass: element.beam.mass(),
            geometric: element.geometric,
            nodes: [ends[0].pipe_below, ends[1].pipe_above],
        });
        let guide = ends.zip(&model.guide).map(|(ends, element)| PlainElement {
            stiffness: element.stiffness,
            mass: element.mass,
            geometric: element.geometric,
            nodes: [ends[0].guide, ends[1].guide],
        });
        let elements = pipe.chain(guide).collect();
        let mut preload = vec![0.0; model.unknowns()];
        for (of_element, nodes) in preloads(model) {
            for (k, couple) in of_element.force.iter().enumerate() {
                preload[nodes[k / 6] + k % 6] += couple;
            }
        }
        let pressure = PipePressure::around(model).map(|pressure| {
            let mut forces = vec![0.0; model.unknowns()];
            for (ends, tension) in model.stations.windows(2).zip(&pressure.unstrained) {
                forces[ends[0].pipe_below] += tension;
                forces[ends[1].pipe_above] -= tension;
            }
            let bottom = &model.stations[model.last()];
            forces[bottom.pipe_above] += pressure.on_end;
            // The seal is in the guide's connector, and pulls it along the pipe's axis.
            for (k, force) in pressure.on_guide.into_iter().enumerate() {
                forces[bottom.guide + k] += force;
            }
            (pressure, forces)
        });
        Self {
            elements,
            preload,
            pressure,
        }
    }

    /// The tool in the numbering of the model.
    pub fn numbered<'a>(&'a self, model: &'a Model) -> Numbered<'a> {
        Numbered {
            model,
            places: &model.places,
            weight: &model.weight,
        }
    }
}

/// The guide's elements with a preload, and the first unknowns of their nodes.
pub(super) fn preloads(model: &Model) -> impl Iterator<Item = (Preload, [usize; 2])> {
    (0..model.guide.len()).filter_map(|e| {
        let nodes = [e, e + 1].map(|station| model.stations[station].guide);
        Some((preload::of_element(model, e)?, nodes))
    })
}

impl Model {
    /// Adds to `forces` (by unknown) those that matrices over the lateral motion of each station, `matrix` of its mud, make
    /// of the motion `x`, by unknown.
    pub fn add_mud_forces(&self, forces: &mut [f64], matrix: impl Fn(&MudLump) -> Lateral, x: impl Fn(usize) -> f64) {
        let Some(mud) = Mud::around(self) else {
            return;
        };
        for (station, mud) in self.stations.iter().zip(&mud.stations) {
            let (pipe, guide) = (station.pipe_above, station.guide);
            let moving = station.pipe_to_station * Vector3::new(x(pipe), x(pipe + 1), x(pipe + 2));
            let matrix = matrix(mud);
            let mut on_pipe = Vector3::zeros();
            for k in 1..3 {
                let at_guide = x(guide + k);
                on_pipe[k] = matrix.pipe * moving[k] + matrix.coupling * at_guide;
                forces[guide + k] += matrix.coupling * moving[k] + matrix.guide * at_guide;
            }
            let on_pipe = station.pipe_to_station.tr_mul(&on_pipe);
            (0..3).for_each(|k| forces[pipe + k] += on_pipe[k]);
        }
    }
}
