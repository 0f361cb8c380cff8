//! Typical forces and lengths of a block, from which its program is made
//! dimensionless.
//!
//! Forces are measured by the wrench that would flow through a body if a
//! breadth-first spanning tree alone held the block, lengths by the levers of
//! its links: never by totals, which would make a tolerance meaningless far from
//! the root of a long structure.

use std::collections::VecDeque;

use crate::spatial::Wrench;

use super::blocks::{Block, Vertex};
use super::frame::LinkFrame;
use super::loads::BodyLoad;
use super::structure::Structure;

/// Smallest lever, as a fraction of the longest in the block.
const SHORTEST: f64 = 3e-5;

/// Typical sizes of a block's quantities.
pub(super) struct Scales {
    /// Force through each of the block's bodies, in N.
    pub force: Vec<f64>,
    /// Lever of each of the block's bodies, in m.
    pub lever: Vec<f64>,
    /// Force through each of the block's links, in N.
    pub link: Vec<f64>,
}

impl Scales {
    /// `frames` are those of the block's links. At least one load must not be zero.
    /// No force is less than `floor` times the largest: a body without weight still needs a scale.
    pub(super) fn new(
        structure: &Structure,
        block: &Block,
        frames: &[LinkFrame],
        loads: &[BodyLoad],
        floor: f64,
    ) -> Self {
        let local = |vertex: Vertex| match vertex {
            Vertex::Body(i) if vertex != block.root => block.bodies.binary_search(&i).ok(),
            _ => None,
        };
        let count = block.bodies.len();
        let com = |i: usize| structure.bodies[block.bodies[i]].com;
        let mut lever = vec![0.0_f64; count];
        let mut neighbours: Vec<Vec<(usize, Option<usize>)>> = vec![Vec::new(); count];
        let mut queue = VecDeque::new();
        let mut parent: Vec<Option<(usize, Option<usize>)>> = vec![None; count];
        let mut seen = vec![false; count];
        for (l, frame) in frames.iter().enumerate() {
            let (plus, minus) = (local(frame.plus), local(frame.minus));
            for (at, other) in [(plus, minus), (minus, plus)] {
                if let Some(i) = at {
                    lever[i] = lever[i].max((frame.origin - com(i)).norm());
                    neighbours[i].push((l, other));
                    if other.is_none() && !seen[i] {
                        seen[i] = true;
                        parent[i] = Some((l, None));
                        queue.push_back(i);
                    }
                }
            }
        }
        let longest = lever.iter().copied().fold(0.0, f64::max);
        let shortest = if longest > 0.0 { longest * SHORTEST } else { 1.0 };
        for value in &mut lever {
            *value = value.max(shortest);
        }
        let mut order = Vec::with_capacity(count);
        while let Some(i) = queue.pop_front() {
            order.push(i);
            for &(l, other) in &neighbours[i] {
                if let Some(next) = other
                    && !seen[next]
                {
                    seen[next] = true;
                    parent[next] = Some((l, Some(i)));
                    queue.push_back(next);
                }
            }
        }
        let mut flow: Vec<Wrench> = block.bodies.iter().map(|&i| loads[i].wrench).collect();
        let mut force: Vec<f64> = Vec::with_capacity(count);
        for (i, &body) in block.bodies.iter().enumerate() {
            force.push(loads[body].force_size.norm() + loads[body].torque_size.norm() / lever[i]);
        }
        for &i in order.iter().rev() {
            force[i] = force[i].max(flow[i].force.norm() + flow[i].torque.norm() / lever[i]);
            if let Some((_, Some(above))) = parent[i] {
                let carried = flow[i].moved(&(com(i) - com(above)));
                flow[above] += carried;
            }
        }
        let largest = force.iter().copied().fold(0.0, f64::max);
        for value in &mut force {
            *value = value.max(floor * largest);
        }
        let link = frames
            .iter()
            .map(|frame| {
                let through = |vertex| local(vertex).map_or(0.0, |i| force[i]);
                let (plus, minus) = (through(frame.plus), through(frame.minus));
                if plus == 0.0 || minus == 0.0 { plus.max(minus) } else { plus.min(minus) }
            })
            .collect();
        Self { force, lever, link }
    }
}
