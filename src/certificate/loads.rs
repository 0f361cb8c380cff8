//! The loads by which it is judged what may be forgiven.

use crate::spatial::Vec3;
use crate::statics::{Anchor, Structure};

use super::balance::movable;

/// For each body, the loads on all that it is linked with other than through the
/// ground: their sum in N, and the most that they can turn a body by, in N m. What is
/// forgiven is judged by these and not by the certificate's own forces, which could
/// be as large as one likes where a structure can be clamped.
pub(super) fn loads(structure: &Structure) -> Vec<(f64, f64)> {
    let mut parts = Parts((0..structure.bodies.len()).collect());
    let mut points: Vec<(usize, Vec3)> = structure.bodies.iter().map(|body| body.com).enumerate().collect();
    let connections = structure.connections.iter().map(|c| (c.parent, c.child, c.frame.translation.vector));
    let contacts = structure.contacts.iter().map(|c| (Anchor::Body(c.body), c.against, c.position));
    for (a, b, at) in connections.chain(contacts) {
        let ends = [movable(structure, a), movable(structure, b)];
        points.extend(ends.into_iter().flatten().map(|body| (body, at)));
        if let [Some(a), Some(b)] = ends {
            parts.join(a, b);
        }
    }
    points.extend(structure.loads.iter().filter_map(|load| Some((load.body, load.at?))));
    // Of each part, by the body that stands for it.
    let mut total = vec![(0.0, 0.0); structure.bodies.len()];
    for (body, data) in structure.bodies.iter().enumerate() {
        total[parts.find(body)].0 += data.mass * structure.gravity.norm();
    }
    for load in &structure.loads {
        let (force, torque) = &mut total[parts.find(load.body)];
        *force += load.force.norm();
        *torque += load.torque.norm();
    }
    let mut corners: Vec<Option<(Vec3, Vec3)>> = vec![None; structure.bodies.len()];
    for (body, point) in points {
        let (low, high) = corners[parts.find(body)].get_or_insert((point, point));
        (*low, *high) = (low.inf(&point), high.sup(&point));
    }
    let turned = |((force, torque), corners): (&(f64, f64), &Option<(Vec3, Vec3)>)| {
        (*force, torque + force * corners.map_or(0.0, |(low, high)| (high - low).norm()))
    };
    let of_part: Vec<(f64, f64)> = total.iter().zip(&corners).map(turned).collect();
    (0..structure.bodies.len()).map(|body| of_part[parts.find(body)]).collect()
}

/// Which bodies are linked: of each, another one of its part, or itself where it stands
/// for the whole part.
struct Parts(Vec<usize>);

impl Parts {
    fn find(&mut self, mut body: usize) -> usize {
        while self.0[body] != body {
            // Halves the way for the next time.
            self.0[body] = self.0[self.0[body]];
            body = self.0[body];
        }
        body
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b);
    }
}
