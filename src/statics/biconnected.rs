//! Searches a graph for its biconnected components.
//!
//! Source: Hopcroft and Tarjan (1973), here without recursion so that rings of 100 000 bodies do
//! not exhaust the stack. Knows vertices and links by their short numbers only, nothing of what
//! is between them.

use smallvec::SmallVec;

use super::blocks::{Block, Blocks, Joined, Vertex, number, unnumber};

/// Adjacency in compressed rows.
pub(super) struct Graph {
    /// Where the links of each vertex begin; one more for the end.
    first: Vec<u32>,
    /// Per vertex and link there: the link, and the vertex at its other end.
    incident: Vec<[u32; 2]>,
}

impl Graph {
    pub(super) fn new(vertices: usize, links: &[(u32, [u32; 2])]) -> Self {
        let mut first = vec![0; vertices + 1];
        for &end in links.iter().flat_map(|(_, ends)| ends) {
            first[end as usize + 1] += 1;
        }
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let mut incident = vec![[0; 2]; first[vertices] as usize];
        for &(link, [a, b]) in links {
            for (end, other) in [(a, b), (b, a)] {
                let place = &mut next[end as usize];
                incident[*place as usize] = [link, other];
                *place += 1;
            }
        }
        Self { first, incident }
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

/// A search and what it has found.
pub(super) struct Search<'g> {
    joined: &'g Joined,
    graph: &'g Graph,
    /// Per vertex the order of its entry from 1, 0 before.
    entered: Vec<u32>,
    clock: u32,
    open_links: Vec<u32>,
    open_bodies: Vec<usize>,
    pub found: Blocks,
}

impl<'g> Search<'g> {
    pub(super) fn new(joined: &'g Joined, graph: &'g Graph, found: Blocks) -> Self {
        Self {
            joined,
            graph,
            entered: vec![0; graph.first.len() - 1],
            clock: 0,
            open_links: Vec::new(),
            open_bodies: Vec::new(),
            found,
        }
    }

    pub(super) fn is_new(&self, vertex: u32) -> bool {
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
    pub(super) fn grow(&mut self, root: Vertex) {
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
        let links = numbers.iter().map(|&link| self.joined.link(link)).collect();
        self.open_links.truncate(links_before);
        let bodies = &mut self.open_bodies[bodies_before..];
        bodies.sort_unstable();
        let bodies = SmallVec::from_slice(bodies);
        self.open_bodies.truncate(bodies_before);
        self.found.blocks.push(Block { root: unnumber(root), bodies, links });
    }
}
