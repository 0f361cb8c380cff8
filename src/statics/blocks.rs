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
    // In a tree every body has a block of its own. What stays is taken from memory before what
    // does not, so that no gap is left in between.
    let found = Blocks { blocks: Vec::with_capacity(structure.bodies.len()), afloat: Vec::new() };
    let graph = Graph::new(structure);
    let mut search = Search::new(&graph, found);
    search.grow(Vertex::Ground);
    for (i, body) in structure.bodies.iter().enumerate() {
        if !body.fixed && search.is_new(number(Vertex::Body(i))) {
            search.found.afloat.push(i);
            search.grow(Vertex::Body(i));
        }
    }
    let mut found = search.found;
    found.blocks.reverse();
    found
}

/// Adjacency in compressed rows: vertex 0 is the ground, `i + 1` is body `i`. Numbers are short,
/// since a search through a large structure waits for memory.
struct Graph {
    /// Number of connections: links are numbered in the structure's order, contacts after them.
    connections: usize,
    /// Where the links of each vertex begin; one more for the end.
    first: Vec<u32>,
    /// Per vertex and link there: the link, and the vertex at its other end.
    incident: Vec<[u32; 2]>,
}

fn number(vertex: Vertex) -> u32 {
    match vertex {
        Vertex::Ground => 0,
        Vertex::Body(i) => short(i + 1),
    }
}

fn unnumber(number: u32) -> Vertex {
    if number == 0 { Vertex::Ground } else { Vertex::Body(number as usize - 1) }
}

/// A number of a body, link or block in half the space.
pub(super) fn short(index: usize) -> u32 {
    u32::try_from(index).expect("memory ends long before four thousand million bodies or links")
}

impl Graph {
    fn new(structure: &Structure) -> Self {
        let connections = structure.connections.len();
        // Asking every link's bodies whether they are fixed would mean waiting for memory.
        let numbers: Vec<u32> =
            structure.bodies.iter().enumerate().map(|(i, body)| if body.fixed { 0 } else { short(i + 1) }).collect();
        let at = |anchor: Anchor| match anchor {
            Anchor::World => 0,
            Anchor::Body(i) => numbers[i],
        };
        let connected = structure.connections.iter().map(|connection| [connection.parent, connection.child]);
        let touching = structure.contacts.iter().map(|contact| [Anchor::Body(contact.body), contact.against]);
        let joined: Vec<[u32; 2]> = connected.chain(touching).map(|ends| ends.map(at)).collect();
        let apart = |(_, [a, b]): &(usize, &[u32; 2])| a != b;
        let mut first = vec![0; structure.bodies.len() + 2];
        for (_, ends) in joined.iter().enumerate().filter(apart) {
            for end in ends {
                first[*end as usize + 1] += 1;
            }
        }
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let mut incident = vec![[0; 2]; first[first.len() - 1] as usize];
        for (index, &[a, b]) in joined.iter().enumerate().filter(apart) {
            for (end, other) in [(a, b), (b, a)] {
                let place = &mut next[end as usize];
                incident[*place as usize] = [short(index), other];
                *place += 1;
            }
        }
        Self { connections, first, incident }
    }

    fn link(&self, number: u32) -> Link {
        let number = number as usize;
        number.checked_sub(self.connections).map_or(Link::Connection(number), Link::Contact)
    }
}

/// A vertex on the way from the root to where the search is.
struct Step {
    at: u32,
    /// The link over which it was entered; that of the root is none of the graph's.
    over: u32,
    /// Its next incident link, and the end of all.
    next: u32,
    end: u32,
    /// Order of its entry, and the earliest entry that its subtree reaches over one back edge.
    entered: u32,
    low: u32,
    /// How many links and bodies were open before it was entered.
    links_before: usize,
    bodies_before: usize,
}

struct Search<'g> {
    graph: &'g Graph,
    /// Per vertex the order of its entry from 1, 0 before.
    entered: Vec<u32>,
    clock: u32,
    open_links: Vec<u32>,
    open_bodies: Vec<usize>,
    found: Blocks,
}

impl<'g> Search<'g> {
    fn new(graph: &'g Graph, found: Blocks) -> Self {
        Self {
            graph,
            entered: vec![0; graph.first.len() - 1],
            clock: 0,
            open_links: Vec::new(),
            open_bodies: Vec::new(),
            found,
        }
    }

    fn is_new(&self, vertex: u32) -> bool {
        self.entered[vertex as usize] == 0
    }

    /// Enters a vertex over a link; the step that leads on from there.
    fn enter(&mut self, at: u32, over: u32) -> Step {
        self.clock += 1;
        let entered = self.clock;
        self.entered[at as usize] = entered;
        let (next, end) = (self.graph.first[at as usize], self.graph.first[at as usize + 1]);
        let (links_before, bodies_before) = (self.open_links.len(), self.open_bodies.len());
        Step { at, over, next, end, entered, low: entered, links_before, bodies_before }
    }

    /// Depth-first search from `root`. A block is complete, and is cut off, when
    /// the search returns over its first edge; blocks farther from the root
    /// complete earlier.
    fn grow(&mut self, root: Vertex) {
        let mut path = vec![self.enter(number(root), u32::MAX)];
        while let Some(step) = path.last_mut() {
            if step.next < step.end {
                let [link, other] = self.graph.incident[step.next as usize];
                step.next += 1;
                if link == step.over {
                    continue;
                }
                if self.is_new(other) {
                    let step = self.enter(other, link);
                    self.open_links.push(link);
                    self.open_bodies.push(other as usize - 1);
                    path.push(step);
                } else if self.entered[other as usize] < step.entered {
                    self.open_links.push(link);
                    step.low = step.low.min(self.entered[other as usize]);
                }
                // Otherwise it leads to where the search came back from, and was followed from there.
            } else {
                let &mut Step { low, links_before, bodies_before, .. } = step;
                path.pop();
                if let Some(parent) = path.last_mut() {
                    parent.low = parent.low.min(low);
                    if low >= parent.entered {
                        let root = parent.at;
                        self.close(root, links_before, bodies_before);
                    }
                }
            }
        }
    }

    fn close(&mut self, root: u32, links_before: usize, bodies_before: usize) {
        let numbers = &mut self.open_links[links_before..];
        numbers.sort_unstable();
        let links = numbers.iter().map(|&link| self.graph.link(link)).collect();
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
