//! The tool as its string sees it in torsion.

use crate::tool::description::{HangingTool, Piece, ToolDescription, TorsionalMode};
use crate::tool::{SectionProperties, WellPath};

impl ToolDescription {
    /// The pipe and the bit in torsion. Joints turn with the pipe, and friction is left out.
    pub fn hanging_tool(&self) -> HangingTool {
        let links = self.links.max(1);
        let length = WellPath::new(&self.well).length() / (links * self.pipe_sections.len().max(1)) as f64;
        // Neighbours that are alike make one piece.
        let mut parts: Vec<(crate::tool::Tube, f64)> = Vec::new();
        for tube in (0..links).flat_map(|_| &self.pipe_sections) {
            match parts.last_mut() {
                Some((last, total)) if last == tube => *total += length,
                _ => parts.push((*tube, length)),
            }
        }
        let wave = |(tube, length)| Piece::of(&SectionProperties::of(tube, self.material, 1.0), length).torsion;
        HangingTool {
            pieces: parts.into_iter().map(wave).collect(),
            inertia: self.inertia_at_end(),
        }
    }

    /// The lowest `most` torsional modes of top drive, string and tool off bottom, by frequency; none without a string.
    pub fn torsional_modes(&self, most: usize) -> Vec<TorsionalMode> {
        self.string
            .as_ref()
            .map_or(Vec::new(), |string| string.torsional_modes(&self.hanging_tool(), most))
    }
}
