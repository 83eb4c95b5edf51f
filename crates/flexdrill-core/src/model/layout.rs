//! Numbering of the model's unknowns: station by station, a block each.

/// Unknowns of a plain station: pipe node, guide node.
pub const PLAIN_BLOCK: usize = 12;
/// Unknowns of a joint station: end of the link above (0..6), guide (6..12), start of the link below (12..18),
/// multipliers (18..23), padding.
pub const JOINT_BLOCK: usize = 24;

/// Where each station's unknowns begin: how q_rd of Eq. 19 is stacked.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    offsets: Vec<usize>,
}

impl Layout {
    /// A layout with a block of 24 where `large` says so, else of 12.
    pub fn new(large: impl Iterator<Item = bool>) -> Self {
        let mut offsets = vec![0];
        let mut offset = 0;
        for is_large in large {
            offset += if is_large { JOINT_BLOCK } else { PLAIN_BLOCK };
            offsets.push(offset);
        }
        Self { offsets }
    }

    /// Number of stations.
    pub fn stations(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of unknowns, padding included.
    pub fn unknowns(&self) -> usize {
        self.offsets[self.stations()]
    }

    /// First unknown of a station.
    pub fn offset(&self, station: usize) -> usize {
        self.offsets[station]
    }

    /// Station of an unknown.
    pub fn station_of(&self, unknown: usize) -> usize {
        self.offsets.partition_point(|&offset| offset <= unknown) - 1
    }
}
