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
    if !kinds.contains(&true) {
        return Vec::new();
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Pose, Rotation};
    use crate::statics::assess::assess;
    use crate::statics::assessment::Question;
    use crate::statics::connector::{Connector, Model};
    use crate::statics::structure::{Body, Connection};

    const WELD: usize = 0;
    const MAGNET: usize = 1;

    /// Bodies 0, 1 and 2 are welded in a ring that two magnets hold to the world; body 5
    /// is welded to body 4, which is fixed; body 3 hangs by magnets between the two.
    fn welded(seed: f64) -> Structure {
        let vector = |k: f64| Vec3::new((seed + k).sin(), (seed * 1.7 + k).cos(), (seed * 2.3 - k).sin());
        let mut welded = Structure { gravity: Vec3::new(0.3, -0.2, -9.81), ..Structure::default() };
        let none = f64::INFINITY;
        let weld = Model::Box { shear: [none; 2], tension: none, compression: none, bending: [none; 2], torsion: none };
        let magnet = Model::Cone { friction: [0.6, 0.4], radius: [0.03, 0.04, 0.05] };
        for (name, model) in [("weld", weld), ("magnet", magnet)] {
            welded.connectors.push(Connector { name: name.to_owned(), strength: 40.0, model });
        }
        for (i, [x, y, z]) in
            [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.3, 0.1, 0.0], [0.5, 0.1, 0.1], [0.4, 0.1, 0.0]]
                .into_iter()
                .enumerate()
        {
            let com = Vec3::new(x, y, z) + vector(i as f64) * 0.01;
            welded.bodies.push(Body { mass: 0.2 + 0.1 * i as f64, com, fixed: i == 4 });
        }
        let body = Anchor::Body;
        let down = Rotation::from_scaled_axis(Vec3::x() * std::f64::consts::PI);
        let any = |k: f64| Rotation::from_scaled_axis(vector(k) * 2.0);
        for (parent, child, connector, at, rotation) in [
            (Anchor::World, body(0), MAGNET, [0.0, 0.0, 0.05], down),
            (Anchor::World, body(1), MAGNET, [0.1, 0.0, 0.05], down),
            (body(0), body(1), WELD, [0.05, 0.0, 0.0], any(1.0)),
            (body(2), body(1), WELD, [0.1, 0.05, 0.0], any(2.0)),
            (body(0), body(2), WELD, [0.05, 0.05, 0.0], any(3.0)),
            (body(2), body(3), MAGNET, [0.2, 0.1, 0.0], any(4.0)),
            (body(5), body(4), WELD, [0.45, 0.1, 0.0], any(5.0)),
            (body(5), body(3), MAGNET, [0.35, 0.1, 0.0], any(6.0)),
        ] {
            let frame = Pose::from_parts(Vec3::from(at).into(), rotation);
            welded.connections.push(Connection { parent, child, connector, frame });
        }
        let (force, torque) = (vector(7.0), vector(8.0) * 0.1);
        welded.loads.push(Load { body: 2, force, torque, at: Some(vector(9.0) * 0.2) });
        welded.loads.push(Load { body: 1, force: vector(10.0), torque: Vec3::zeros(), at: None });
        welded
    }

    #[test]
    fn what_is_welded_becomes_one() {
        let original = welded(0.0);
        let merged = Merged::new(&original).expect("there are welds");
        assert_eq!(merged.of, [Some(0), Some(0), Some(0), Some(3), None, None]);
        assert_eq!(merged.bodies_saved(&original), 3);
        let free: Vec<bool> = merged.structure.bodies.iter().map(|body| !body.fixed).collect();
        assert_eq!(free, [true, false, false, true, false, false]);
        // It has to hold what its bodies had to, about its own centre.
        let mut sum = BodyLoad::ZERO;
        let centre = merged.structure.bodies[0].com;
        for (load, body) in own_loads(&original).iter().zip(&original.bodies).take(3) {
            sum += load.moved(&(body.com - centre));
        }
        let found = own_loads(&merged.structure)[0].wrench;
        assert!((found.force - sum.wrench.force).norm() <= 1e-12 * sum.force_size.norm());
        assert!((found.torque - sum.wrench.torque).norm() <= 1e-12 * sum.torque_size.norm());
        // Welds within it join it to itself; the others lead to where they did.
        let ends = |i: usize| (merged.structure.connections[i].parent, merged.structure.connections[i].child);
        assert_eq!(ends(3), (Anchor::Body(0), Anchor::Body(0)));
        assert_eq!(ends(5), (Anchor::Body(0), Anchor::Body(3)));
    }

    #[test]
    fn without_welds_there_is_nothing_to_merge() {
        let mut bolted = welded(0.0);
        if let Model::Box { torsion, .. } = &mut bolted.connectors[WELD].model {
            *torsion = 1e9;
        }
        assert!(Merged::new(&bolted).is_none());
    }

    /// The original structure balances with the wrenches that are carried back.
    #[test]
    fn every_body_balances_with_the_wrenches_carried_back() {
        for seed in 0..20 {
            let original = welded(f64::from(seed));
            let answer = assess(&original, Question::VALUE).expect("a valid structure");
            assert!(answer.utilisation.upper.is_finite() && answer.left_out.merged_bodies == 3);
            let mut sums = own_loads(&original);
            let sizes: Vec<f64> = sums.iter().map(|load| load.force_size.norm()).collect();
            for (i, state) in answer.connections.iter().enumerate() {
                let frame = LinkFrame::new(&original, Link::Connection(i));
                for (side, sign) in frame.sides() {
                    if let Vertex::Body(body) = side {
                        let push =
                            frame.in_world(&state.wrench).moved(&(frame.origin - original.bodies[body].com)) * sign;
                        sums[body].wrench += push;
                    }
                }
            }
            for (i, body) in original.bodies.iter().enumerate().filter(|(_, body)| !body.fixed) {
                let (force, torque) = (sums[i].wrench.force.norm(), sums[i].wrench.torque.norm());
                assert!(
                    force <= 1e-9 * sizes[i] && torque <= 1e-10 * sizes[i],
                    "{seed}: {body:?} {force:e} {torque:e}"
                );
            }
            // The ring is closed by one weld more than a tree needs; none demands anything.
            let welds = [2, 3, 4].map(|i| &answer.connections[i]);
            assert_eq!(welds.iter().filter(|state| state.wrench == Wrench::ZERO).count(), 1);
            assert!(welds.iter().all(|state| (state.strength, state.utilisation) == (0.0, 0.0)));
        }
    }

    /// The mechanism that is carried back moves nothing across a weld, opens every
    /// magnet, and its power over what they dissipate is the lower bound.
    #[test]
    fn the_mechanism_carried_back_is_admissible() {
        for seed in 0..20 {
            let original = welded(f64::from(seed));
            let answer = assess(&original, Question::VALUE).expect("a valid structure");
            let mut dissipated = 0.0;
            for (i, connection) in original.connections.iter().enumerate() {
                let frame = LinkFrame::new(&original, Link::Connection(i));
                let relative = frame.relative_twist(&original, |body| answer.mechanism[body]);
                let Twist { linear: v, angular: w } = relative;
                match &original.connectors[connection.connector].model {
                    Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                        let rubbing = Vec3::new(c * w.x, d * w.y, e * w.z).norm().hypot((a * v.x).hypot(b * v.y));
                        assert!(v.z >= rubbing, "{seed}: {i} opens at {} of {rubbing}", v.z);
                        dissipated += original.connectors[connection.connector].strength * v.z;
                    }
                    Model::Box { .. } | Model::Patch { .. } => {
                        let speed = answer.mechanism.iter().map(|twist| twist.linear.norm()).fold(0.0, f64::max);
                        assert!(v.norm() <= 1e-12 * speed && w.norm() <= 1e-10 * speed, "{seed}: {i} {relative:?}");
                    }
                }
            }
            let loads = own_loads(&original);
            let power: f64 = answer.mechanism.iter().zip(&loads).map(|(twist, load)| twist.power(&load.wrench)).sum();
            let lower = answer.utilisation.lower;
            assert!(lower > 0.0 && (power / dissipated - lower).abs() <= 1e-9 * lower, "{seed}: {power} {dissipated}");
        }
    }
}
