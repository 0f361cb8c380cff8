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

use super::structure::{Anchor, Structure};

/// A vertex of the graph: the ground (the world and every fixed body), or a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Vertex {
    Ground,
    Body(usize),
}

/// A connection or contact, by its index in the structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    pub bodies: Vec<usize>,
    /// Its connections and contacts, in the structure's order.
    pub links: Vec<Link>,
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
        let mut numbers = self.open_links.split_off(links_before);
        numbers.sort_unstable();
        let mut bodies = self.open_bodies.split_off(bodies_before);
        bodies.sort_unstable();
        let links = numbers.into_iter().map(|link| self.graph.links[link].0).collect();
        self.found.blocks.push(Block { root: unnumber(root), bodies, links });
    }
}
