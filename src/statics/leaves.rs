//! Peels the leaves off a graph, and what thereby becomes a leaf, until there is none.
//!
//! A tree is peeled as a whole, without a search: vertices have their turn in their order in
//! memory, and no list of a vertex's edges is needed. Knows nothing of what vertices and edges
//! stand for.

use super::blocks::short;

/// A vertex that hung from another one by its last edge when it was peeled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub at: u32,
    pub from: u32,
    pub edge: u32,
}

/// How many edges a vertex has left, and the exclusive or of their numbers and of those of the
/// vertices at their other ends. Of a single edge, these are its own.
#[derive(Clone, Copy, Default)]
struct Rest {
    degree: u32,
    edges: u32,
    others: u32,
}

impl Rest {
    fn toggle(&mut self, edge: u32, other: u32) {
        self.edges ^= edge;
        self.others ^= other;
    }
}

/// A graph without its leaves.
pub(super) struct Peeled {
    /// Every leaf after those that hung from it.
    pub leaves: Vec<Leaf>,
    rests: Vec<Rest>,
}

impl Peeled {
    /// Peels the graph of the numbered `edges` between two vertices each. Vertex 0 is the
    /// root and no leaf.
    pub(super) fn new(vertices: usize, edges: impl Iterator<Item = (u32, [u32; 2])>) -> Self {
        let mut rests = vec![Rest::default(); vertices];
        for (edge, [a, b]) in edges {
            for (end, other) in [(a, b), (b, a)] {
                let rest = &mut rests[end as usize];
                rest.degree += 1;
                rest.toggle(edge, other);
            }
        }
        let mut leaves = Vec::with_capacity(vertices);
        for start in (1..short(vertices)).rev() {
            let mut at = start;
            // What comes before `start` has its turn later.
            while at >= start && rests[at as usize].degree == 1 {
                let Rest { edges: edge, others: from, .. } = rests[at as usize];
                leaves.push(Leaf { at, from, edge });
                let holder = &mut rests[from as usize];
                holder.degree -= 1;
                holder.toggle(edge, at);
                at = from;
            }
        }
        Self { leaves, rests }
    }

    /// Whether a vertex was peeled: it keeps its last edge, and nothing else has just one.
    pub(super) fn is_leaf(&self, vertex: u32) -> bool {
        vertex != 0 && self.rests[vertex as usize].degree == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random multigraphs, peeled anew with a list of edges.
    #[test]
    fn every_leaf_hangs_by_its_last_edge_and_none_is_left() {
        let mut state = 1_u64;
        let mut below = |bound: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as u32 % bound
        };
        for _ in 0..2000 {
            let vertices = 2 + below(9);
            let pairs = (0..below(12)).map(|_| [below(vertices), below(vertices)]).filter(|[a, b]| a != b);
            let mut left: Vec<(u32, [u32; 2])> = (0..).zip(pairs).collect();
            let peeled = Peeled::new(vertices as usize, left.iter().copied());
            for leaf in &peeled.leaves {
                let (own, others): (Vec<_>, Vec<_>) = left.into_iter().partition(|(_, ends)| ends.contains(&leaf.at));
                let [(edge, [a, b])] = own[..] else { panic!("{leaf:?} has {own:?}") };
                assert_eq!((leaf.edge, leaf.from), (edge, a + b - leaf.at));
                left = others;
            }
            for vertex in 1..vertices {
                let degree = left.iter().filter(|(_, ends)| ends.contains(&vertex)).count();
                assert_ne!(degree, 1, "{left:?}");
                let peeled_off = peeled.leaves.iter().any(|leaf| leaf.at == vertex);
                assert_eq!(peeled.is_leaf(vertex), peeled_off);
            }
            assert!(!peeled.is_leaf(0) && peeled.leaves.iter().all(|leaf| leaf.at != 0));
        }
    }
}
