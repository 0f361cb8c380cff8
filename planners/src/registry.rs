//! States as dense numbers, so that what a search knows of a state is a column
//! of plain data. Each state is stored once.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Number of a state in order of discovery.
pub(crate) type StateId = u32;

/// End of a chain of states with one hash.
const NONE: StateId = StateId::MAX;

/// States met so far, numbered in order of discovery.
pub(crate) struct Registry<T> {
    states: Vec<T>,
    /// First state with a hash; never iterated over.
    first: HashMap<u64, StateId>,
    /// Next state with the same hash.
    next: Vec<StateId>,
}

impl<T: Eq + Hash> Registry<T> {
    pub fn new() -> Self {
        Registry { states: Vec::new(), first: HashMap::new(), next: Vec::new() }
    }

    /// The number of a state, and whether it is new.
    pub fn insert(&mut self, state: T) -> (StateId, bool) {
        let mut hasher = DefaultHasher::new();
        state.hash(&mut hasher);
        let hash = hasher.finish();
        let mut id = self.first.get(&hash).copied().unwrap_or(NONE);
        while id != NONE {
            if self.states[id as usize] == state {
                return (id, false);
            }
            id = self.next[id as usize];
        }
        let id = StateId::try_from(self.states.len()).expect("memory ends before 2^32 states");
        self.next.push(self.first.insert(hash, id).unwrap_or(NONE));
        self.states.push(state);
        (id, true)
    }

    pub fn state(&self, id: StateId) -> &T {
        &self.states[id as usize]
    }

    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Approximate bytes for each state, without the heap that it owns.
    pub const fn bytes_per_state() -> usize {
        // The hash table keeps a quarter of its slots free, with one byte of control each.
        size_of::<T>() + size_of::<StateId>() + (size_of::<(u64, StateId)>() + 1) * 4 / 3
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hash that is the same for everything.
    #[derive(PartialEq, Eq)]
    struct Colliding(u32);

    impl Hash for Colliding {
        fn hash<H: Hasher>(&self, state: &mut H) {
            0_u8.hash(state);
        }
    }

    #[test]
    fn states_that_collide_stay_apart() {
        let mut registry = Registry::new();
        for round in 0..2 {
            for n in 0..20 {
                assert_eq!(registry.insert(Colliding(n)), (n, round == 0));
            }
        }
        assert_eq!(registry.len(), 20);
        assert!((0..20).all(|n| registry.state(n).0 == n));
    }
}
