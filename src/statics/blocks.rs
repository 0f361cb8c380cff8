//! Cuts a structure into pieces that can be solved one by one.
//!
//! The bodies, with the world and all fixed bodies as one vertex, are the
//! vertices of a graph whose edges are the connections and contacts. Cut at its
//! articulation bodies it falls into biconnected blocks, which form a tree
//! rooted at the world. Whatever happens inside a block, the wrench that it
//! passes on through its root body is the sum of the loads beyond: so each
//! block is a problem of its own, with its root held and the loads of the blocks
//! that hang from its bodies lumped onto those bodies. A block of one edge (a
//! bridge) needs no optimisation.
//!
//! Source: statics in two-terminal reductions is folklore; biconnected
//! components after Hopcroft and Tarjan (1973), here without recursion so that
//! chains of 100 000 bodies do not exhaust the stack.

use smallvec::SmallVec;

use super::structure::{Anchor, Structure};

/// A vertex of the graph: the ground (the world and every fixed body), or a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Vertex {
    Ground,
    Body(usize),
}

/// A connection or contact, by its index in the structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Link {
    Connection(usize),
    Contact(usize),
}

/// A biconnected piece of the structure.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Where it hangs from: held while the block is solved.
    pub root: Vertex,
    /// The bodies that need balance, the root not among them.
    pub bodies: SmallVec<[usize; 1]>,
    /// Its connections and contacts, in the structure's order.
    pub links: SmallVec<[Link; 1]>,
}

/// The pieces of a structure.
#[derive(Clone, Debug, Default)]
pub(super) struct Blocks {
    /// Every block after the one that holds its root's own root.
    pub blocks: Vec<Block>,
    /// One body of every component without any way to the ground.
    pub afloat: Vec<usize>,
}

/// The vertex that an anchor stands for.
pub(super) fn vertex(structure: &Structure, anchor: Anchor) -> Vertex {
    match anchor {
        Anchor::World => Vertex::Ground,
        Anchor::Body(i) if structure.bodies[i].fixed => Vertex::Ground,
        Anchor::Body(i) => Vertex::Body(i),
    }
}

/// The two vertices that a link joins.
pub(super) fn ends(structure: &Structure, link: Link) -> [Vertex; 2] {
    match link {
        Link::Connection(i) => {
            let connection = &structure.connections[i];
            [vertex(structure, connection.parent), vertex(structure, connection.child)]
        }
        Link::Contact(i) => {
            let contact = &structure.contacts[i];
            [vertex(structure, Anchor::Body(contact.body)), vertex(structure, contact.against)]
        }
    }
}

/// Cuts `structure` into blocks. Links between two immovable things carry
/// nothing and belong to no block.
pub(super) fn cut(structure: &Structure) -> Blocks {
    let graph = Graph::new(structure);
    let mut search = Search::new(&graph);
    search.grow(Vertex::Ground);
    for (i, body) in structure.bodies.iter().enumerate() {
        if !body.fixed && search.entered[i + 1] == 0 {
            search.found.afloat.push(i);
            search.grow(Vertex::Body(i));
        }
    }
    let mut found = search.found;
    found.blocks.reverse();
    found
}

/// Adjacency in compressed rows: vertex 0 is the ground, `i + 1` is body `i`.
struct Graph {
    links: Vec<(Link, [usize; 2])>,
    first: Vec<usize>,
    incident: Vec<usize>,
}

fn number(vertex: Vertex) -> usize {
    match vertex {
        Vertex::Ground => 0,
        Vertex::Body(i) => i + 1,
    }
}

fn unnumber(number: usize) -> Vertex {
    if number == 0 { Vertex::Ground } else { Vertex::Body(number - 1) }
}

impl Graph {
    fn new(structure: &Structure) -> Self {
        let connections = (0..structure.connections.len()).map(Link::Connection);
        let contacts = (0..structure.contacts.len()).map(Link::Contact);
        let links: Vec<(Link, [usize; 2])> = connections
            .chain(contacts)
            .map(|link| (link, ends(structure, link).map(number)))
            .filter(|(_, [a, b])| a != b)
            .collect();
        let mut first = vec![0; structure.bodies.len() + 2];
        for (_, ends) in &links {
            for end in ends {
                first[end + 1] += 1;
            }
        }
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let mut incident = vec![0; 2 * links.len()];
        for (index, (_, ends)) in links.iter().enumerate() {
            for end in ends {
                incident[next[*end]] = index;
                next[*end] += 1;
            }
        }
        Self { links, first, incident }
    }
}

struct Search<'g> {
    graph: &'g Graph,
    /// Order of entry from 1, 0 before.
    entered: Vec<usize>,
    /// Earliest entry that the subtree reaches over one back edge.
    low: Vec<usize>,
    clock: usize,
    used: Vec<bool>,
    open_links: Vec<usize>,
    open_bodies: Vec<usize>,
    found: Blocks,
}

impl<'g> Search<'g> {
    fn new(graph: &'g Graph) -> Self {
        let vertices = graph.first.len() - 1;
        Self {
            graph,
            entered: vec![0; vertices],
            low: vec![0; vertices],
            clock: 0,
            used: vec![false; graph.links.len()],
            open_links: Vec::new(),
            open_bodies: Vec::new(),
            found: Blocks::default(),
        }
    }

    fn enter(&mut self, vertex: usize) {
        self.clock += 1;
        self.entered[vertex] = self.clock;
        self.low[vertex] = self.clock;
    }

    /// Depth-first search from `root`. A block is complete, and is cut off, when
    /// the search returns over its first edge; blocks farther from the root
    /// complete earlier.
    fn grow(&mut self, root: Vertex) {
        // (vertex, next incident link, open links and bodies before it was entered)
        let root = number(root);
        self.enter(root);
        let mut path = vec![(root, self.graph.first[root], 0, 0)];
        while let Some(&mut (at, ref mut next, links_before, bodies_before)) = path.last_mut() {
            if *next < self.graph.first[at + 1] {
                let link = self.graph.incident[*next];
                *next += 1;
                if std::mem::replace(&mut self.used[link], true) {
                    continue;
                }
                let [a, b] = self.graph.links[link].1;
                let other = if a == at { b } else { a };
                let marks = (self.open_links.len(), self.open_bodies.len());
                self.open_links.push(link);
                if self.entered[other] == 0 {
                    self.enter(other);
                    self.open_bodies.push(other - 1);
                    path.push((other, self.graph.first[other], marks.0, marks.1));
                } else {
                    self.low[at] = self.low[at].min(self.entered[other]);
                }
            } else {
                path.pop();
                if let Some(&(parent, ..)) = path.last() {
                    self.low[parent] = self.low[parent].min(self.low[at]);
                    if self.low[at] >= self.entered[parent] {
                        self.close(parent, links_before, bodies_before);
                    }
                }
            }
        }
    }

    fn close(&mut self, root: usize, links_before: usize, bodies_before: usize) {
        let numbers = &mut self.open_links[links_before..];
        numbers.sort_unstable();
        let links = numbers.iter().map(|&link| self.graph.links[link].0).collect();
        self.open_links.truncate(links_before);
        let bodies = &mut self.open_bodies[bodies_before..];
        bodies.sort_unstable();
        let bodies = SmallVec::from_slice(bodies);
        self.open_bodies.truncate(bodies_before);
        self.found.blocks.push(Block { root: unnumber(root), bodies, links });
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use petgraph::algo::connected_components;
    use petgraph::graph::UnGraph;

    use super::super::structure::{Body, Contact};
    use super::*;
    use crate::spatial::Vec3;

    /// Bodies that touch as `pairs` say; 0 is the world, `i + 1` is body `i`.
    fn touching(bodies: usize, pairs: &[[usize; 2]]) -> Structure {
        let body = Body { mass: 1.0, com: Vec3::zeros(), fixed: false };
        let contacts = pairs.iter().map(|&[a, b]| Contact {
            body: a.max(b) - 1,
            against: if a.min(b) == 0 { Anchor::World } else { Anchor::Body(a.min(b) - 1) },
            position: Vec3::zeros(),
            normal: Vec3::z(),
            friction: 0.5,
        });
        Structure { bodies: vec![body; bodies], contacts: contacts.collect(), ..Structure::default() }
    }

    fn components(vertices: usize, pairs: impl Iterator<Item = [usize; 2]>) -> usize {
        let mut graph = UnGraph::<(), ()>::default();
        let nodes: Vec<_> = (0..vertices).map(|_| graph.add_node(())).collect();
        for [a, b] in pairs {
            graph.add_edge(nodes[a], nodes[b], ());
        }
        connected_components(&graph)
    }

    /// Random multigraphs; cuts found by taking away one thing at a time.
    #[test]
    fn blocks_meet_exactly_at_cut_vertices_and_single_links_are_bridges() {
        let mut state = 1_u64;
        let mut below = |bound: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % bound
        };
        for _ in 0..2000 {
            let bodies = 1 + below(8);
            let mut pairs = Vec::new();
            for _ in 0..below(13) {
                let (a, b) = (below(bodies + 1), below(bodies + 1));
                if a != b {
                    pairs.push([a, b]);
                }
            }
            let found = cut(&touching(bodies, &pairs));
            let whole = components(bodies + 1, pairs.iter().copied());
            assert_eq!(found.afloat.len() + 1, whole, "{pairs:?}");

            let mut seen = vec![0; bodies + 1];
            let mut links = BTreeSet::new();
            for block in &found.blocks {
                for vertex in block.bodies.iter().map(|&i| i + 1).chain([number(block.root)]) {
                    seen[vertex] += 1;
                }
                for link in &block.links {
                    let Link::Contact(i) = *link else { panic!("there are only contacts") };
                    assert!(links.insert(i), "{pairs:?}: link {i} twice");
                    let others = pairs.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, pair)| *pair);
                    let bridge = components(bodies + 1, others) > whole;
                    assert_eq!(block.links.len() == 1, bridge, "{pairs:?}: link {i}");
                }
            }
            assert_eq!(links.len(), pairs.len());
            for (vertex, blocks) in seen.into_iter().enumerate() {
                let others = pairs.iter().filter(|pair| !pair.contains(&vertex)).copied();
                let alone = usize::from(blocks > 0);
                // Without its links the vertex itself is one more component.
                let cuts = components(bodies + 1, others) > whole + alone;
                assert_eq!(blocks > 1, cuts, "{pairs:?}: vertex {vertex}");
            }
        }
    }

    #[test]
    fn a_block_comes_after_the_one_it_hangs_from() {
        let found = cut(&touching(5, &[[0, 1], [1, 2], [2, 3], [1, 3], [3, 4], [4, 5]]));
        let mut held = BTreeSet::from([0]);
        for block in &found.blocks {
            assert!(held.contains(&number(block.root)), "{block:?}");
            held.extend(block.bodies.iter().map(|&i| i + 1));
        }
        assert_eq!(held.len(), 6);
    }

    #[test]
    fn long_chains_and_long_rings_do_not_exhaust_the_stack() {
        let count = 100_000;
        let mut pairs: Vec<[usize; 2]> = (0..count).map(|i| [i, i + 1]).collect();
        assert_eq!(cut(&touching(count, &pairs)).blocks.len(), count);
        pairs.push([count, 0]);
        let ring = cut(&touching(count, &pairs));
        assert_eq!((ring.blocks.len(), ring.blocks[0].bodies.len()), (1, count));
    }

    #[test]
    fn fixed_bodies_are_ground() {
        let mut structure = touching(3, &[[0, 1], [1, 2], [2, 3], [1, 3]]);
        structure.bodies[0].fixed = true;
        let found = cut(&structure);
        assert_eq!(found.blocks.len(), 1);
        assert_eq!((found.blocks[0].root, &found.blocks[0].bodies[..]), (Vertex::Ground, &[1, 2][..]));
        assert_eq!(found.blocks[0].links.len(), 3);
    }
}
