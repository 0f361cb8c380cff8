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
//! What hangs by one link alone is peeled off first (`leaves`): a tree is nothing but that,
//! and a search through a large one would wait for memory at every step.
//!
//! Source: statics in two-terminal reductions is folklore.

use smallvec::{SmallVec, smallvec};

use super::biconnected::{Graph, Search};
use super::leaves::{Leaf, Peeled};
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
    let vertices = structure.bodies.len() + 1;
    // In a tree every body has a block of its own. What stays is taken from memory before what
    // does not, so that no gap is left in between.
    let found = Blocks { blocks: Vec::with_capacity(structure.bodies.len()), afloat: Vec::new() };
    let joined = Joined::new(structure);
    let peeled = Peeled::new(vertices, joined.links());
    let core = joined.links().filter(|(_, ends)| !ends.iter().any(|&end| peeled.is_leaf(end)));
    let graph = Graph::new(vertices, &core.collect::<Vec<_>>());
    let mut search = Search::new(&joined, &graph, found);
    search.grow(Vertex::Ground);
    for (i, body) in structure.bodies.iter().enumerate() {
        let number = number(Vertex::Body(i));
        if !body.fixed && !peeled.is_leaf(number) && search.is_new(number) {
            search.found.afloat.push(i);
            search.grow(Vertex::Body(i));
        }
    }
    let mut found = search.found;
    found.blocks.reverse();
    let hanging = peeled.leaves.iter().rev().map(|&Leaf { at, from, edge }| Block {
        root: unnumber(from),
        bodies: smallvec![at as usize - 1],
        links: smallvec![joined.link(edge)],
    });
    found.blocks.extend(hanging);
    found
}

pub(super) fn number(vertex: Vertex) -> u32 {
    match vertex {
        Vertex::Ground => 0,
        Vertex::Body(i) => short(i + 1),
    }
}

pub(super) fn unnumber(number: u32) -> Vertex {
    if number == 0 { Vertex::Ground } else { Vertex::Body(number as usize - 1) }
}

/// A number of a body, link or block in half the space.
pub(super) fn short(index: usize) -> u32 {
    u32::try_from(index).expect("memory ends long before four thousand million bodies or links")
}

/// The ends of all links, by number: vertex 0 is the ground, `i + 1` is body `i`; links are
/// numbered in the structure's order, contacts after connections. Numbers are short, since going
/// through a large structure means waiting for memory.
pub(super) struct Joined {
    connections: usize,
    ends: Vec<[u32; 2]>,
}

impl Joined {
    fn new(structure: &Structure) -> Self {
        // Asking every link's bodies whether they are fixed would mean waiting for memory.
        let numbers: Vec<u32> =
            structure.bodies.iter().enumerate().map(|(i, body)| if body.fixed { 0 } else { short(i + 1) }).collect();
        let at = |anchor: Anchor| match anchor {
            Anchor::World => 0,
            Anchor::Body(i) => numbers[i],
        };
        let connected = structure.connections.iter().map(|connection| [connection.parent, connection.child]);
        let touching = structure.contacts.iter().map(|contact| [Anchor::Body(contact.body), contact.against]);
        let ends = connected.chain(touching).map(|ends| ends.map(at)).collect();
        Self { connections: structure.connections.len(), ends }
    }

    /// The links, by number, that join two different vertices.
    fn links(&self) -> impl Iterator<Item = (u32, [u32; 2])> {
        (0..short(self.ends.len())).zip(self.ends.iter().copied()).filter(|(_, [a, b])| a != b)
    }

    pub(super) fn link(&self, number: u32) -> Link {
        let number = number as usize;
        number.checked_sub(self.connections).map_or(Link::Connection(number), Link::Contact)
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
                for vertex in block.bodies.iter().map(|&i| i + 1).chain([number(block.root) as usize]) {
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
            held.extend(block.bodies.iter().map(|&i| number(Vertex::Body(i))));
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
