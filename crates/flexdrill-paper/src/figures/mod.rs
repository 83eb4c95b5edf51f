//! The paper's figures, drawn from a record. What a figure is and how it is drawn: `flexdrill-plot`.

mod forces;
mod shapes;
mod speeds;

pub use flexdrill_plot::{DrawError, Figure, Legend, Line, Mark, Panel, csv, svg};

use super::hinge::Hinge;
use super::motion::motion;
use super::record::Record;
use flexdrill_core::tool::Body;

/// Figures 9 to 17.
pub fn figures(record: &Record, hinge: &Hinge) -> Vec<Figure> {
    let pipe = motion(record, Body::Pipe);
    let guide = motion(record, Body::Guide);
    vec![
        hinge_figure(hinge),
        shapes::shapes(record, &pipe, Body::Pipe),
        shapes::shapes(record, &guide, Body::Guide),
        speeds::pipe(record),
        speeds::guide(record, &guide),
        forces::inner(record),
        forces::outer(record),
        forces::pipe_acceleration(record),
        forces::guide_acceleration(record),
    ]
}

/// Fig. 9.
fn hinge_figure(hinge: &Hinge) -> Figure {
    let series = |values: Vec<f64>| hinge.time.iter().copied().zip(values).collect::<Vec<_>>();
    let form = |form: &dyn Fn(f64) -> f64| series(hinge.load.iter().map(|&load| -1e3 * form(load)).collect());
    let (corrected, printed) = hinge.worst();
    let deflection = Panel::new("(a) Displacement of the hinge", "time (s)", "displacement (mm)")
        .line(Line::new("analytic, corrected", form(&|load| hinge.beam.corrected(load))).wide())
        .line(Line::new("analytic, Eq. 45 as printed", form(&|load| hinge.beam.printed(load))).dashed())
        .line(Line::new("numerical", series(hinge.numerical.iter().map(|w| -1e3 * w).collect())).thin())
        .legend(Legend::Stacked);
    let errors = hinge.errors().map(|(time, error)| (time, 100.0 * error)).collect();
    let error = Panel::new(
        "(b) Error of the numerical against the corrected solution",
        "time (s)",
        "error (%)",
    )
    .line(Line::new("", errors));
    Figure {
        name: "fig09_hinge_displacement",
        title: "Figure 9. Displacement of the hinge, analytic against numerical".to_owned(),
        caption: format!(
            "Largest difference over the largest deflection: {:.2} % to the corrected closed form, {:.0} % to the printed one (paper: \
             0.9 % to its own).",
            100.0 * corrected,
            100.0 * printed
        ),
        columns: 2,
        height: 420,
        panels: vec![deflection, error],
    }
}
