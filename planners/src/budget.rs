//! How much a search may spend.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What a [`Search`](crate::Search) may spend over all its passes. The default is unlimited.
///
/// Limits are looked at between expansions, so a search ends late by at most
/// one expansion or certification.
#[derive(Clone, Debug, Default)]
pub struct Budget {
    /// When to stop.
    pub deadline: Option<Instant>,
    /// Most expansions; expanding a state again counts again.
    pub max_expansions: Option<u64>,
    /// Most memory in bytes (see [`Statistics::bytes`]). A search ends when seven eighths of it are used: the last
    /// one is for what a single expansion may add, tables that grow included.
    pub max_bytes: Option<usize>,
    /// Measures the memory in use, in bytes, where the caller knows better than to believe approximate counts.
    pub measure_bytes: Option<fn() -> Option<usize>>,
    /// Becomes true when the search should stop, from any thread.
    pub cancel: Option<Arc<AtomicBool>>,
}

/// Why a search ended without an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Limit {
    /// The deadline has passed.
    Deadline,
    /// The number of expansions was used up.
    Expansions,
    /// The memory was used up.
    Memory,
    /// The caller cancelled.
    Cancelled,
    /// Everything was searched, but certified intervals are too wide to decide.
    Precision,
    /// The method looks at a part of all paths only, and has looked at all of that. No engine of this package ends so.
    Incomplete,
}

/// What a search has done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// States expanded; one that is expanded again counts again.
    pub expanded: u64,
    /// Distinct transitions generated.
    pub generated: u64,
    /// Calls of [`Space::certify`](crate::Space::certify).
    pub certified: u64,
    /// Distinct states met.
    pub states: usize,
    /// Peak memory in bytes: as [measured](Budget::measure_bytes), or else approximately that of states, transitions,
    /// labels, queues and what the space [remembers](crate::Space::memory_bytes), without allocator overhead and the heap that actions own.
    pub bytes: usize,
}

impl Budget {
    /// The first limit that is exceeded when so much is spent.
    pub fn exceeded(&self, spent: &Statistics) -> Option<Limit> {
        if self.cancel.as_ref().is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
            Some(Limit::Cancelled)
        } else if self.max_expansions.is_some_and(|most| spent.expanded >= most) {
            Some(Limit::Expansions)
        } else if self.max_bytes.is_some_and(|most| spent.bytes > most - most / 8) {
            Some(Limit::Memory)
        } else if self.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            Some(Limit::Deadline)
        } else {
            None
        }
    }
}
