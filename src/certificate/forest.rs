//! A forest of connections to the ground, which carries what rounding leaves on every
//! body. Any forest would make a proof; a strong one makes a narrow bracket.

use std::collections::BinaryHeap;

use crate::statics::{Anchor, Connector, Model, Structure};

use super::balance::{Sum, arm, movable};
use super::face::largest_triangle;
use super::interval::Axes;
use super::models::{Push, limits};

/// A body, and the connection that holds it with the body behind that one; both
/// `None` where no connection leads on to the ground, and the latter at the ground.
pub(super) type Branch = (usize, Option<(usize, Option<usize>)>);

/// A forest of connections that can carry any wrench, each body after the one that
/// holds it: strong connections first, since what they carry on top costs least.
/// Any forest would make a proof.
pub(super) fn forest(structure: &Structure) -> Vec<Branch> {
    let mut links = vec![Vec::new(); structure.bodies.len() + 1];
    let ground = structure.bodies.len();
    for (index, connection) in structure.connections.iter().enumerate() {
        let ends = [connection.parent, connection.child].map(|end| movable(structure, end).unwrap_or(ground));
        if let Some(holding) = holding(&structure.connectors[connection.connector])
            && ends[0] != ends[1]
        {
            // The bits of positive numbers are in their order.
            links[ends[0]].push((holding.to_bits(), index, ends[1]));
            links[ends[1]].push((holding.to_bits(), index, ends[0]));
        }
    }
    let mut branches = Vec::with_capacity(structure.bodies.len());
    let mut reached = vec![false; structure.bodies.len() + 1];
    // Where the ground is not reached the heaviest body is the root: what rounding leaves
    // on it need not be carried by what carries less.
    let mut roots: Vec<usize> = (0..structure.bodies.len()).collect();
    roots.sort_by(|a, b| structure.bodies[*b].mass.total_cmp(&structure.bodies[*a].mass));
    for root in std::iter::once(ground).chain(roots) {
        if reached[root] || (root != ground && structure.bodies[root].fixed) {
            continue;
        }
        reached[root] = true;
        if root != ground {
            branches.push((root, None));
        }
        let mut waiting: BinaryHeap<_> = links[root].iter().map(|&(h, index, to)| (h, index, root, to)).collect();
        while let Some((_, index, from, body)) = waiting.pop() {
            if !reached[body] {
                reached[body] = true;
                branches.push((body, Some((index, (from != ground).then_some(from)))));
                waiting.extend(links[body].iter().map(|&(h, index, to)| (h, index, body, to)));
            }
        }
    }
    branches
}

/// Carries what every body lacks along the forest: the wrench that each connection has
/// to carry on top, on its child in its frame, and what is left at the forest's roots
/// that are not the ground.
pub(super) fn carry(structure: &Structure, forest: &[Branch], sums: &[Sum]) -> (Vec<Push>, Vec<(usize, Push)>) {
    let mut surplus: Vec<Push> = sums.iter().map(|sum| sum.surplus).collect();
    let mut rest = vec![Push::ZERO; structure.connections.len()];
    let mut left = Vec::new();
    for &(body, holder) in forest.iter().rev() {
        let Some((index, behind)) = holder else {
            left.push((body, surplus[body]));
            continue;
        };
        let connection = &structure.connections[index];
        let at = &connection.frame.translation.vector;
        let here = surplus[body].moved(&-arm(structure, body, at));
        if let Some(behind) = behind {
            surplus[behind] = surplus[behind].plus(&here.moved(&arm(structure, behind, at)));
        }
        let axes = Axes::of(&connection.frame.rotation);
        let local = Push { force: axes.to_local(&here.force), torque: axes.to_local(&here.torque) };
        // The connection takes the surplus away from the body.
        rest[index] = if connection.child == Anchor::Body(body) { local.negative() } else { local };
    }
    (rest, left)
}

/// How well a connector carries any wrench whatever, a measure for choosing among
/// several; `None` when there are wrenches that it cannot carry.
fn holding(connector: &Connector) -> Option<f64> {
    let least = |limits: &[f64]| limits.iter().copied().fold(f64::INFINITY, f64::min);
    let holding = match &connector.model {
        Model::Cone { friction, radius } => connector.strength * least(friction).min(least(radius)),
        Model::Box { .. } => least(limits(&connector.model).as_flattened()),
        Model::Patch { friction, points } => {
            largest_triangle(points).map_or(0.0, |_| connector.strength * friction.min(1.0))
        }
    };
    (holding > 0.0).then_some(holding)
}
