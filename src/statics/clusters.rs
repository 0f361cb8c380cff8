//! Lets groups of a block's bodies move as one.
//!
//! A twist field in which clusters of bodies move rigidly is a restricted one,
//! so whatever it proves holds for the block: inside a cluster nothing opens or
//! slips, exactly. What remains is a smaller structure of the same kind.

use petgraph::unionfind::UnionFind;

use crate::spatial::{Twist, Vec3};

use super::blocks::{Block, Link, Vertex, ends};
use super::loads::BodyLoad;
use super::structure::{Anchor, Body, Connection, Structure};

/// Bodies of a block that move as one.
#[derive(PartialEq, Eq)]
pub(super) struct Clusters {
    /// Cluster of each of the block's bodies; `None` for those held by the root.
    of: Vec<Option<usize>>,
    count: usize,
}

impl Clusters {
    /// Joins the two ends of every link of the block, by its index there, that
    /// `fuses`; what is joined to the root is held.
    pub(super) fn new(structure: &Structure, block: &Block, fuses: impl Fn(usize, Link) -> bool) -> Self {
        let root = block.bodies.len();
        let slot = |vertex: Vertex| match vertex {
            Vertex::Body(i) if vertex != block.root => block.bodies.binary_search(&i).unwrap_or(root),
            _ => root,
        };
        let mut joined = UnionFind::<usize>::new(root + 1);
        for (index, &link) in block.links.iter().enumerate() {
            if fuses(index, link) {
                let [a, b] = ends(structure, link);
                joined.union(slot(a), slot(b));
            }
        }
        let held = joined.find(root);
        let mut number = vec![None; root + 1];
        let mut count = 0;
        let of = (0..root)
            .map(|i| {
                let name = joined.find(i);
                (name != held).then(|| {
                    *number[name].get_or_insert_with(|| {
                        count += 1;
                        count - 1
                    })
                })
            })
            .collect();
        Self { of, count }
    }

    /// How many move.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The cluster of one of the block's bodies; `None` where the root holds it.
    pub(super) fn of_body(&self, block: &Block, body: usize) -> Option<usize> {
        self.cluster(block, Vertex::Body(body))
    }

    fn cluster(&self, block: &Block, vertex: Vertex) -> Option<usize> {
        match vertex {
            Vertex::Body(i) if vertex != block.root => {
                block.bodies.binary_search(&i).ok().and_then(|slot| self.of[slot])
            }
            _ => None,
        }
    }

    /// The structure of the clusters, each one body, centred at the mean of its
    /// bodies' positions, with what it has to hold, and the links between them.
    /// `None` when nothing can move or nothing that can move is loaded.
    pub(super) fn reduce(&self, structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Option<Reduced> {
        if self.count == 0 {
            return None;
        }
        let mut members = vec![0.0; self.count];
        let mut centres = vec![Vec3::zeros(); self.count];
        for (slot, cluster) in self.of.iter().enumerate() {
            if let Some(c) = *cluster {
                members[c] += 1.0;
                centres[c] += structure.bodies[block.bodies[slot]].com;
            }
        }
        for (centre, count) in centres.iter_mut().zip(&members) {
            *centre /= *count;
        }
        let mut lumped = vec![BodyLoad::ZERO; self.count];
        for (slot, cluster) in self.of.iter().enumerate() {
            if let Some(c) = *cluster {
                let body = block.bodies[slot];
                lumped[c] += loads[body].moved(&(structure.bodies[body].com - centres[c]));
            }
        }
        let mut reduced = Structure { connectors: structure.connectors.clone(), ..Structure::default() };
        reduced.bodies = centres.iter().map(|com| Body { mass: 0.0, com: *com, fixed: false }).collect();
        let (mut connection_origins, mut contact_origins) = (Vec::new(), Vec::new());
        let anchor = |vertex| self.cluster(block, vertex).map_or(Anchor::World, Anchor::Body);
        for (index, &link) in block.links.iter().enumerate() {
            let [a, b] = ends(structure, link).map(anchor);
            if a == b {
                continue;
            }
            match link {
                Link::Connection(i) => {
                    let connection = Connection { parent: a, child: b, ..structure.connections[i].clone() };
                    reduced.connections.push(connection);
                    connection_origins.push(index);
                }
                Link::Contact(i) => {
                    let mut contact = structure.contacts[i].clone();
                    match a {
                        Anchor::Body(body) => (contact.body, contact.against) = (body, b),
                        // The body is held: let the normal point into the other one.
                        Anchor::World => {
                            let Anchor::Body(other) = b else { continue };
                            (contact.body, contact.against) = (other, a);
                            contact.normal = -contact.normal;
                        }
                    }
                    reduced.contacts.push(contact);
                    contact_origins.push(index);
                }
            }
        }
        let connections = (0..reduced.connections.len()).map(Link::Connection);
        let links = connections.chain((0..reduced.contacts.len()).map(Link::Contact)).collect();
        let block = Block { root: Vertex::Ground, bodies: (0..self.count).collect(), links };
        connection_origins.extend(contact_origins);
        let origins = connection_origins;
        (!lumped.iter().all(BodyLoad::is_zero)).then_some(Reduced { structure: reduced, block, loads: lumped, origins })
    }

    /// The twists of all the block's bodies when the clusters of `reduced` move with `twists`.
    pub(super) fn spread(
        &self,
        structure: &Structure,
        block: &Block,
        reduced: &Reduced,
        twists: &[Twist],
    ) -> Vec<Twist> {
        let of = self.of.iter().zip(&block.bodies);
        of.map(|(cluster, &body)| {
            let arm = |c: usize| structure.bodies[body].com - reduced.structure.bodies[c].com;
            cluster.map_or(Twist::ZERO, |c| twists[c].moved(&arm(c)))
        })
        .collect()
    }
}

/// A block's clusters as a structure of their own.
pub(super) struct Reduced {
    pub structure: Structure,
    /// All of it, hanging from the ground.
    pub block: Block,
    pub loads: Vec<BodyLoad>,
    /// For each of its links, the index of the link in the original block.
    pub origins: Vec<usize>,
}
