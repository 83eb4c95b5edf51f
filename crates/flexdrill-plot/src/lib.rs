//! Figures as plain data ([`Figure`]); [`svg`] draws one, `png` (feature `png`) renders the drawing, and [`csv()`]
//! writes its data.

mod draw;
mod panel;
#[cfg(feature = "png")]
mod png;

pub use draw::{DrawError, svg, svg_of_width};
pub use panel::{Figure, Legend, Line, Mark, Panel, csv};
#[cfg(feature = "png")]
pub use png::png;
