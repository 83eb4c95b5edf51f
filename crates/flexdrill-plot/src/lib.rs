//! Figures as plain data ([`Figure`]); [`svg`] draws one, and [`csv()`] writes its data.

mod draw;
mod panel;

pub use draw::{DrawError, sheet, svg, svg_of_width};
pub use panel::{Figure, Legend, Line, Mark, Panel, csv};
