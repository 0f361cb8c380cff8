//! Repairs a twist field that a few links do not admit.
//!
//! A field that opens *every* link, and every one by more than it makes it slip,
//! is added in the smallest sufficient share. Expansion from a point behind the
//! supports is such a field for most structures: all parts move away from each
//! other and from the supports. The reserve of a link, how much more it opens
//! than it slips, is a concave and positively homogeneous function of the relative
//! twist, so `reserve(v + e b) >= reserve(v) + e reserve(b)`: the share is found
//! link by link.

use crate::spatial::{Twist, Vec3};

use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::Model;
use super::super::program::local_body;
use super::super::second_order::norm;

/// Depth of the apex behind the supports over the distance of the farthest body.
const DEPTH: f64 = 2.0;

/// Excess of the share over what the formula asks for: rounding.
const EXCESS: f64 = 1.0 + 1e-6;

/// Share below which the reserve of the repaired field could be rounding, over the
/// size of the field.
const LEAST: f64 = 1e-12;

/// The expansion of the block's bodies from a point behind its supports.
pub(super) fn breathing(problem: &Problem<'_>) -> Vec<Twist> {
    let Problem { structure, block, program, .. } = *problem;
    let (mut middle, mut inward, mut count) = (Vec3::zeros(), Vec3::zeros(), 0.0);
    for frame in &program.frames {
        let sides = frame.sides();
        if sides.iter().any(|(side, _)| local_body(block, *side).is_none()) {
            let sign = sides.iter().find(|(side, _)| local_body(block, *side).is_some()).map_or(0.0, |side| side.1);
            middle += frame.origin;
            inward += frame.axes.column(2) * sign;
            count += 1.0;
        }
    }
    let middle = middle / f64::max(count, 1.0);
    let com = |body: usize| structure.bodies[body].com;
    let far = block.bodies.iter().map(|&body| (com(body) - middle).norm()).fold(0.0, f64::max);
    let apex = middle - inward.try_normalize(0.0).unwrap_or_else(Vec3::zeros) * (DEPTH * far);
    block.bodies.iter().map(|&body| Twist::new((com(body) - apex) / far.max(f64::MIN_POSITIVE), Vec3::zeros())).collect()
}

/// Adds to `twists` the least share of `breathing` that makes every link admit
/// them; whether there is one.
pub(super) fn repair(problem: &Problem<'_>, twists: &mut [Twist]) -> bool {
    let mut share = 0.0_f64;
    let reserves = reserves(problem, twists);
    let largest = twists.iter().map(|twist| twist.linear.norm()).fold(0.0, f64::max);
    if reserves.iter().all(|reserve| *reserve >= LEAST * largest) {
        return true;
    }
    let breathing = breathing(problem);
    for (reserve, more) in reserves.iter().zip(self::reserves(problem, &breathing)) {
        let lacking = LEAST * largest - reserve;
        if lacking > 0.0 {
            if !(more > 0.0) {
                return false;
            }
            share = share.max(lacking / more);
        }
    }
    for (twist, more) in twists.iter_mut().zip(&breathing) {
        twist.linear += more.linear * (share * EXCESS);
    }
    true
}

/// How much more every link opens than it slips, in m/s; without a limit for
/// what may move in any way.
pub(super) fn reserves(problem: &Problem<'_>, twists: &[Twist]) -> Vec<f64> {
    let Problem { structure, block, program, .. } = *problem;
    let twist = |body: usize| block.bodies.binary_search(&body).map_or(Twist::ZERO, |i| twists[i]);
    let links = block.links.iter().zip(&program.frames);
    links
        .map(|(&link, frame)| {
            let relative = frame.relative_twist(structure, twist);
            let Twist { linear: v, angular: w } = relative;
            match link {
                Link::Contact(i) => v.z - structure.contacts[i].friction * v.xy().norm(),
                Link::Connection(i) => {
                    match &structure.connectors[structure.connections[i].connector].model {
                        Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                            v.z - norm(&[a * v.x, b * v.y, c * w.x, d * w.y, e * w.z])
                        }
                        Model::Box { compression, .. } if compression.is_infinite() => v.z,
                        Model::Box { .. } => f64::INFINITY,
                        Model::Patch { friction, points } => points
                            .iter()
                            .map(|p| {
                                let at = relative.at(&Vec3::new(p[0], p[1], 0.0));
                                at.z - friction * at.xy().norm()
                            })
                            .fold(f64::INFINITY, f64::min),
                    }
                }
            }
        })
        .collect()
}
