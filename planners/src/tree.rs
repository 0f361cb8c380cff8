//! The best known way to every state that a search has settled.

use crate::graph::Arrow;
use crate::registry::StateId;

/// What a search has decided about a state.
#[derive(Clone, Copy)]
struct Label<V> {
    value: V,
    /// The last transition of the way there; `None` at the root.
    via: Option<Arrow>,
}

/// A column of labels, one for each settled state.
pub(crate) struct Tree<V> {
    labels: Vec<Option<Label<V>>>,
    settled: Vec<StateId>,
}

impl<V: Copy> Tree<V> {
    pub fn new() -> Self {
        Tree { labels: Vec::new(), settled: Vec::new() }
    }

    /// Forgets all labels in time proportional to their number.
    pub fn clear(&mut self) {
        for id in self.settled.drain(..) {
            self.labels[id as usize] = None;
        }
    }

    /// Value of a state, if it is settled.
    pub fn value(&self, id: StateId) -> Option<V> {
        self.labels.get(id as usize).copied().flatten().map(|label| label.value)
    }

    /// Settles a state, or replaces its label.
    pub fn settle(&mut self, id: StateId, value: V, via: Option<Arrow>) {
        let index = id as usize;
        if self.labels.len() <= index {
            self.labels.resize(index + 1, None);
        }
        if self.labels[index].replace(Label { value, via }).is_none() {
            self.settled.push(id);
        }
    }

    /// Transitions from the root to a settled state.
    pub fn way_to(&self, id: StateId) -> Vec<Arrow> {
        let via = |id: StateId| self.labels[id as usize].expect("ways lead to settled states").via;
        let mut arrows: Vec<Arrow> = std::iter::successors(via(id), |arrow| via(arrow.from)).collect();
        arrows.reverse();
        arrows
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        self.labels.len() * size_of::<Option<Label<V>>>() + self.settled.len() * size_of::<StateId>()
    }
}
