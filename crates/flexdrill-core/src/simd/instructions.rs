//! Which vector instructions to use, found at run time.

use std::sync::atomic::{AtomicU8, Ordering};

/// Which vector instructions the machine has. With AVX2 and with AVX-512 every number is the same to the bit, since both round a product
/// and a sum once and in the same order (`tests/mechanics_machines.rs`); without either, products are rounded by themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// None asked for.
    Portable,
    /// AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512 F and VL.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    /// From the least to the best.
    pub fn all() -> impl Iterator<Item = Self> {
        [
            Self::Portable,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2,
            #[cfg(target_arch = "x86_64")]
            Self::Avx512,
        ]
        .into_iter()
    }

    /// Whether this machine has them.
    pub fn available(&self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("fma") && is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.available() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")
            }
        }
    }

    /// The best that this machine has, and that [`Instructions::limit`] allows.
    pub fn of_this_machine() -> Self {
        let most = LIMIT.load(Ordering::Relaxed);
        let allowed = |instructions: &Self| *instructions as u8 <= most && instructions.available();
        Self::all().filter(allowed).last().unwrap_or(Self::Portable)
    }

    /// Lets models that this process makes from now on use these instructions at most: to see what another machine would do.
    pub fn limit(self) {
        LIMIT.store(self as u8, Ordering::Relaxed);
    }
}

static LIMIT: AtomicU8 = AtomicU8::new(u8::MAX);
