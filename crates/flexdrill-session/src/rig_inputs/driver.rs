//! A publisher of an input: its id, node and host.

use std::fmt;

use flexdrill_text::printable;

/// Bytes of an id that identify the process; the others identify the writer in it.
const PROCESS: usize = 12;

/// A publisher: the GUID of its DDS writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DriverId(pub [u8; 16]);

impl DriverId {
    /// Whether both belong to one DDS participant, which is one process.
    pub fn same_process(&self, other: &Self) -> bool {
        self.0[..PROCESS] == other.0[..PROCESS]
    }
}

/// Hexadecimal, a dot between the process and the writer in it.
impl fmt::Display for DriverId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, byte) in self.0.iter().enumerate() {
            if index == PROCESS {
                write!(f, ".")?;
            }
            write!(f, "{byte:02x}")?;
        }
        Ok(())
    }
}

/// A publisher with its node and host, as far as discovery knows them. `Display` is `node @ host (id)`, with the source
/// that its messages name: `node @ host (id) of wits 10.0.0.7; well 3`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Driver {
    /// Its writer.
    pub id: DriverId,
    /// Absolute name of its node, where known.
    pub node: Option<String>,
    /// Address or name of its machine, where known.
    pub host: Option<String>,
    /// Sensor or program that its messages name; empty where they name none. One writer with two sources is two
    /// publishers: a bridge may carry several rigs.
    pub source: String,
}

impl Driver {
    /// A publisher of which only the id is known.
    pub fn unknown(id: DriverId) -> Self {
        Self {
            id,
            node: None,
            host: None,
            source: String::new(),
        }
    }
}

impl fmt::Display for Driver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let node = self.node.as_deref().unwrap_or("unnamed node");
        let host = self.host.as_deref().unwrap_or("unknown host");
        write!(f, "{} @ {} ({})", printable(node), printable(host), self.id)?;
        if self.source.is_empty() {
            return Ok(());
        }
        // Readers of a list split it at commas, and find an id by its brackets.
        let source = self.source.replace(',', ";").replace('(', "[").replace(')', "]");
        write!(f, " of {}", printable(&source))
    }
}
