//! Makes one body of what connections without any finite limit hold together.
//!
//! Such a connection demands nothing whatever it carries, and nothing moves
//! across it in any mechanism: its bodies balance together or not at all. What
//! joins a group to itself otherwise may then carry nothing. What the unlimited
//! connections themselves carry follows from balance afterwards, along a spanning
//! tree of each group; those beside the tree carry nothing.

use petgraph::unionfind::UnionFind;

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::Assessment;
use super::blocks::{Link, Vertex, ends};
use super::frame::LinkFrame;
use super::loads::{BodyLoad, own_loads};
use super::structure::{Anchor, Load, Structure};

/// A structure in which groups of bodies are one.
pub(super) struct Merged {
    /// Of the same bodies, connections and contacts: the first body of a group
    /// stands for all, centred at the mean of their positions, with their weights as loads.
    /// The others hold and load nothing, and links within a group join its body to itself.
    pub structure: Structure,
    /// Body that stands for each body; `None` for what is held to the ground.
    of: Vec<Option<usize>>,
}

impl Merged {
    /// `None` when there is nothing to merge.
    pub(super) fn new(structure: &Structure) -> Option<Self> {
        let unlimited = unlimited(structure);
        if unlimited.is_empty() {
            return None;
        }
        let bodies = structure.bodies.len();
        let number = |vertex: Vertex| match vertex {
            Vertex::Ground => bodies,
            Vertex::Body(i) => i,
        };
        let mut joined = UnionFind::<usize>::new(bodies + 1);
        for &connection in &unlimited {
            let [a, b] = ends(structure, Link::Connection(connection)).map(number);
            joined.union(a, b);
        }
        let ground = joined.find(bodies);
        let mut first = vec![None; bodies + 1];
        let of = (0..bodies).map(|i| {
            let name = joined.find(i);
            (name != ground && !structure.bodies[i].fixed).then(|| *first[name].get_or_insert(i))
        });
        let of: Vec<Option<usize>> = of.collect();
        Some(Self { structure: merge(structure, &of), of })
    }

    /// Free bodies of `original` that another one, or the ground, stands for.
    pub(super) fn bodies_saved(&self, original: &Structure) -> usize {
        let bodies = self.of.iter().zip(&original.bodies).enumerate();
        bodies.filter(|(i, (of, body))| **of != Some(*i) && !body.fixed).count()
    }

    /// Carries the answer for the merged structure back to `original`.
    pub(super) fn undo(&self, original: &Structure, mut answer: Assessment) -> Assessment {
        let twist = |(i, of): (usize, &Option<usize>)| {
            of.map_or(Twist::ZERO, |k| {
                answer.mechanism[k].moved(&(original.bodies[i].com - self.structure.bodies[k].com))
            })
        };
        answer.mechanism = self.of.iter().enumerate().map(twist).collect();
        answer.left_out.fixed_bodies = original.bodies.iter().filter(|body| body.fixed).count();
        answer.left_out.merged_bodies = self.bodies_saved(original);
        if answer.utilisation.upper.is_finite() {
            balance_groups(original, &mut answer);
        }
        answer
    }
}

/// The connections that demand nothing whatever they carry.
pub(super) fn unlimited(structure: &Structure) -> Vec<usize> {
    let kinds: Vec<bool> = structure.connectors.iter().map(|connector| connector.model.is_unlimited()).collect();
    (0..structure.connections.len()).filter(|&i| kinds[structure.connections[i].connector]).collect()
}

fn merge(structure: &Structure, of: &[Option<usize>]) -> Structure {
    let mut merged = structure.clone();
    let mut members = vec![0_usize; of.len()];
    for k in of.iter().flatten() {
        members[*k] += 1;
    }
    let grouped = |body: usize| of[body].filter(|&k| members[k] > 1);
    // A body on its own stays as it is.
    let mut centres = vec![Vec3::zeros(); of.len()];
    for (i, body) in structure.bodies.iter().enumerate() {
        if let Some(k) = grouped(i) {
            centres[k] += body.com / members[k] as f64;
        }
        merged.bodies[i].fixed = of[i] != Some(i);
    }
    for load in &mut merged.loads {
        if let Some(k) = grouped(load.body) {
            load.at = load.at.or(Some(structure.bodies[load.body].com));
            load.body = k;
        }
    }
    for (i, body) in structure.bodies.iter().enumerate() {
        if let Some(k) = grouped(i) {
            let force = structure.gravity * body.mass;
            merged.loads.push(Load { body: k, force, torque: Vec3::zeros(), at: Some(body.com) });
            merged.bodies[i].mass = 0.0;
            merged.bodies[k].com = centres[k];
        }
    }
    let anchor = |anchor: Anchor| match anchor {
        Anchor::Body(i) => of[i].map_or(anchor, Anchor::Body),
        Anchor::World => Anchor::World,
    };
    for connection in &mut merged.connections {
        (connection.parent, connection.child) = (anchor(connection.parent), anchor(connection.child));
    }
    for contact in &mut merged.contacts {
        contact.body = of[contact.body].unwrap_or(contact.body);
        contact.against = anchor(contact.against);
    }
    merged
}

/// A body with the connection that holds it in a spanning tree, and what to.
struct Held {
    body: usize,
    by: usize,
    to: Vertex,
}

/// Spanning trees of the unlimited connections, every body after what it is held to.
fn spanning_trees(structure: &Structure) -> Vec<Held> {
    let mut incident: Vec<Vec<(usize, Vertex)>> = vec![Vec::new(); structure.bodies.len()];
    let mut from_ground = Vec::new();
    for by in unlimited(structure) {
        let ends = ends(structure, Link::Connection(by));
        for (here, there) in [(ends[0], ends[1]), (ends[1], ends[0])] {
            match here {
                Vertex::Ground => from_ground.push((by, there)),
                Vertex::Body(i) => incident[i].push((by, there)),
            }
        }
    }
    let mut reached: Vec<bool> = structure.bodies.iter().map(|body| body.fixed).collect();
    let mut trees: Vec<Held> = Vec::new();
    let mut grow = |start: Vertex, from: &[(usize, Vertex)]| {
        let mut next = trees.len();
        let (mut to, mut at) = (start, from);
        loop {
            for &(by, other) in at {
                if let Vertex::Body(body) = other
                    && !std::mem::replace(&mut reached[body], true)
                {
                    trees.push(Held { body, by, to });
                }
            }
            let Some(held) = trees.get(next) else { return };
            (to, at) = (Vertex::Body(held.body), &incident[held.body]);
            next += 1;
        }
    };
    grow(Vertex::Ground, &from_ground);
    // What nothing leads to yet begins a tree of its own.
    for body in 0..structure.bodies.len() {
        grow(Vertex::Body(body), &[(usize::MAX, Vertex::Body(body))]);
    }
    trees.retain(|held| held.by != usize::MAX);
    trees
}

/// Gives the unlimited connections the wrenches with which every body balances.
fn balance_groups(structure: &Structure, answer: &mut Assessment) {
    let mut carried = own_loads(structure);
    let mut add = |link: Link, force: Vec3, torque: Vec3| {
        let frame = LinkFrame::new(structure, link);
        for (side, sign) in frame.sides() {
            if let Vertex::Body(i) = side {
                carried[i].add(&(force * sign), &(torque * sign), &(frame.origin - structure.bodies[i].com));
            }
        }
    };
    for (i, state) in answer.connections.iter().enumerate().filter(|(_, state)| state.wrench != Wrench::ZERO) {
        let axes = structure.connections[i].frame.rotation;
        add(Link::Connection(i), axes * state.wrench.force, axes * state.wrench.torque);
    }
    for (i, force) in answer.contacts.iter().enumerate().filter(|(_, force)| **force != Vec3::zeros()) {
        add(Link::Contact(i), *force, Vec3::zeros());
    }
    for Held { body, by, to } in spanning_trees(structure).into_iter().rev() {
        let frame = LinkFrame::new(structure, Link::Connection(by));
        let com = structure.bodies[body].com;
        let load: BodyLoad = carried[body];
        let held = load.moved(&(com - frame.origin)).wrench;
        let sign = if frame.plus == Vertex::Body(body) { -1.0 } else { 1.0 };
        answer.connections[by].wrench =
            Wrench::new(frame.axes.tr_mul(&held.force), frame.axes.tr_mul(&held.torque)) * sign;
        if let Vertex::Body(other) = to {
            carried[other] += load.moved(&(com - structure.bodies[other].com));
        }
    }
}
