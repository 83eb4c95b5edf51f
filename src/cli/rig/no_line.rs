//! The line of WITS in a build without bridges: there is none.

use std::convert::Infallible;
use std::net::SocketAddr;
use std::path::Path;

use super::super::absent;
use super::Batch;

/// No value of it exists.
pub(super) struct WitsLine(Infallible);

impl WitsLine {
    /// # Errors
    /// Always: this build has no bridges.
    #[expect(clippy::unused_async, reason = "the line of a build with bridges waits here")]
    pub(super) async fn open(_address: SocketAddr, _map: Option<&Path>, _well: &str) -> anyhow::Result<Self> {
        Err(absent::refusal("WITS", "bridge"))
    }

    pub(super) fn address(&self) -> SocketAddr {
        match self.0 {}
    }

    pub(super) fn connections(&self) -> u64 {
        match self.0 {}
    }

    pub(super) fn send(&mut self, _batch: &Batch<'_>, _now: i64) -> u64 {
        match self.0 {}
    }
}
