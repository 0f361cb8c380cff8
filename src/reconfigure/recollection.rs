//! What states at rest leave for their neighbours: a bounded number of memories of the oracle.
//!
//! Knows layouts and memories; does not know what is asked of them.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex};

use crate::robot::{Occupancy, Placement};
use crate::statics::Memory;

use super::layout::Layout;

/// Modules that all memories together may have.
const MODULES: usize = 1 << 13;

/// About what a memory takes for each module, in bytes: two or three connections with the forces at their points, and its
/// share of a factored matrix.
const BYTES: usize = 4096;

/// Memories of layouts with every possible connection engaged, the latest ones. Which are kept depends on what is
/// asked, never on time: searches ask from one thread.
#[derive(Debug, Default)]
pub struct Recollection(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    memories: HashMap<Layout, Arc<Memory>>,
    /// In the order in which they came.
    order: VecDeque<Layout>,
}

impl Recollection {
    /// The memory of a layout, if it is still kept.
    pub fn of(&self, layout: &Layout) -> Option<Arc<Memory>> {
        self.0.lock().expect("no thread panics while it holds memories").memories.get(layout).cloned()
    }

    /// Keeps a memory; the oldest are forgotten.
    pub fn keep(&self, layout: &Layout, memory: Arc<Memory>) {
        let mut kept = self.0.lock().expect("no thread panics while it holds memories");
        if kept.memories.insert(layout.clone(), memory).is_none() {
            kept.order.push_back(layout.clone());
        }
        // One is of use even where it is of a large robot.
        while kept.order.len() > 1 && kept.order.len() * layout.placed().len() > MODULES {
            if let Some(oldest) = kept.order.pop_front() {
                kept.memories.remove(&oldest);
            }
        }
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        let kept = self.0.lock().expect("no thread panics while it holds memories");
        kept.order.front().map_or(0, |layout| kept.order.len() * layout.placed().len() * BYTES)
    }
}

/// Which module of a robot was in the cell where each of its modules is now, by index. `None` where there was none.
pub fn matching(before: &[Placement], after: &[Placement]) -> Vec<Option<usize>> {
    let before = Occupancy::of_placements(before);
    after.iter().map(|placement| before.at(placement.cell)).collect()
}
