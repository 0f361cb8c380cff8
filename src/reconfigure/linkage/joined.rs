//! What holds the bodies of a linkage together.
//!
//! Knows joints and connections; knows no forces.

use petgraph::unionfind::UnionFind;

use crate::robot::linkage::{Connection, Linkage};

use super::assembly::BodyOf;

/// The bodies of a linkage, and what joins them.
pub struct Joined {
    first: Vec<usize>,
    /// All bodies, module by module.
    pub bodies: Vec<BodyOf>,
}

impl Joined {
    /// The bodies of a linkage.
    pub fn new(linkage: &Linkage) -> Self {
        let mut first = Vec::with_capacity(linkage.modules.len());
        let mut bodies = Vec::new();
        for module in 0..linkage.modules.len() {
            first.push(bodies.len());
            bodies.extend((0..linkage.module_type(module).bodies.len()).map(|body| BodyOf { module, body }));
        }
        Self { first, bodies }
    }

    /// Index of a body in [`Joined::bodies`].
    pub fn index(&self, body: BodyOf) -> usize {
        self.first[body.module] + body.body
    }

    /// What holds together by joints and connections.
    pub fn whole(&self, linkage: &Linkage) -> UnionFind<usize> {
        self.sides(linkage, |_, _| true, |_| true)
    }

    /// The sides of a connection that is left out.
    pub fn without_connection(&self, linkage: &Linkage, left_out: Connection) -> UnionFind<usize> {
        self.sides(linkage, |_, _| true, |connection| connection != left_out)
    }

    /// The sides of a joint that is left out.
    pub fn without_joint(&self, linkage: &Linkage, module: usize, joint: usize) -> UnionFind<usize> {
        self.sides(linkage, |m, j| (m, j) != (module, joint), |_| true)
    }

    fn sides(
        &self,
        linkage: &Linkage,
        joint_holds: impl Fn(usize, usize) -> bool,
        connection_holds: impl Fn(Connection) -> bool,
    ) -> UnionFind<usize> {
        let mut sets = UnionFind::new(self.bodies.len());
        for module in 0..linkage.modules.len() {
            for (index, joint) in linkage.module_type(module).joints.iter().enumerate() {
                if joint_holds(module, index) {
                    sets.union(self.first[module] + joint.parent, self.first[module] + joint.child);
                }
            }
        }
        for &connection in linkage.connections.iter().filter(|&&connection| connection_holds(connection)) {
            let [a, b] = connection.ports.map(|port| {
                let body = linkage.module_type(port.module).ports[port.port].body;
                self.index(BodyOf { module: port.module, body })
            });
            sets.union(a, b);
        }
        sets
    }
}
