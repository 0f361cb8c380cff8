//! Typical forces and lengths of a block, from which its program is made
//! dimensionless.
//!
//! Forces are measured by the wrench that would flow through a body if a
//! breadth-first spanning tree alone held the block, lengths by the levers of
//! its links: never by totals, which would make a tolerance meaningless far from
//! the root of a long structure.

use std::collections::VecDeque;

use smallvec::SmallVec;

use crate::spatial::{Vec3, Wrench};

use super::blocks::Block;
use super::frame::LinkFrame;
use super::loads::BodyLoad;
use super::maps::Ends;

/// Smallest lever, as a fraction of the longest in the block.
const SHORTEST: f64 = 3e-5;

/// Share of the largest force below which a body holds nothing of its own.
const NOTHING: f64 = 1e-15;

/// Share of what a neighbour holds that a body which holds nothing counts as passing on:
/// enough for the program, and little enough for the accuracy of its balance.
const PASSED_ON: f64 = 1e-3;

/// The links at a body, each with the body at its other end.
type Neighbours = SmallVec<[(usize, Option<usize>); 4]>;

/// Gives every body that holds nothing of its own a share of the force of the neighbour
/// it would pass least on for: a body without weight between two with weight carries at
/// most as much as the lighter one. Those that hold something, or have no such neighbour, get `least`.
fn pass_through(force: &mut [f64], largest: f64, least: f64, neighbours: &[Neighbours]) {
    let passing: Vec<usize> = (0..force.len()).filter(|&i| !(force[i] > NOTHING * largest)).collect();
    for &i in &passing {
        force[i] = 0.0;
    }
    for value in force.iter_mut().filter(|value| **value > 0.0) {
        *value = value.max(least);
    }
    let mut idle = passing.clone();
    loop {
        let lightest = |i: &usize| {
            let beside = neighbours[*i].iter().filter_map(|(_, other)| other.map(|j| force[j]));
            beside.filter(|force| *force > 0.0).fold(f64::INFINITY, f64::min)
        };
        let found: Vec<f64> = idle.iter().map(lightest).collect();
        for (&i, &value) in idle.iter().zip(&found).filter(|(_, value)| value.is_finite()) {
            force[i] = value;
        }
        let before = idle.len();
        idle.retain(|&i| force[i] == 0.0);
        if idle.len() == before {
            break;
        }
    }
    for i in passing {
        force[i] = (force[i] * PASSED_ON).max(least);
    }
}

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
    /// `coms` are the centres of mass of the block's bodies, `frames` and `ends` are those of its links. At least one load must not be zero.
    /// No force is less than `floor` times the largest, and that of a body that holds
    /// nothing is what it may have to pass on.
    pub(super) fn new(
        block: &Block,
        coms: &[Vec3],
        frames: &[LinkFrame],
        ends: &[Ends],
        loads: &[BodyLoad],
        floor: f64,
    ) -> Self {
        let count = block.bodies.len();
        let mut lever = vec![0.0_f64; count];
        let mut neighbours: Vec<Neighbours> = vec![SmallVec::new(); count];
        let mut queue = VecDeque::new();
        let mut parent: Vec<Option<(usize, Option<usize>)>> = vec![None; count];
        let mut seen = vec![false; count];
        for (l, (frame, &[plus, minus])) in frames.iter().zip(ends).enumerate() {
            for (at, other) in [(plus, minus), (minus, plus)] {
                if let Some(i) = at {
                    lever[i] = lever[i].max((frame.origin - coms[i]).norm());
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
                let carried = flow[i].moved(&(coms[i] - coms[above]));
                flow[above] += carried;
            }
        }
        let largest = force.iter().copied().fold(0.0, f64::max);
        pass_through(&mut force, largest, floor * largest, &neighbours);
        let through = |end: Option<usize>| end.map_or(0.0, |i| force[i]);
        let link = ends.iter().map(|ends| {
            let [plus, minus] = ends.map(through);
            if plus == 0.0 || minus == 0.0 { plus.max(minus) } else { plus.min(minus) }
        });
        let link = link.collect();
        Self { force, lever, link }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of bodies, each linked to the next.
    fn row(count: usize) -> Vec<Neighbours> {
        let beside = |i: usize| {
            let before = i.checked_sub(1).map(|j| (j, Some(j)));
            before.into_iter().chain((i + 1 < count).then_some((i, Some(i + 1)))).collect()
        };
        (0..count).map(beside).collect()
    }

    #[test]
    fn what_holds_nothing_passes_on_a_share_of_the_lighter_neighbour() {
        let mut force = [40.0, 0.0, 0.0, 10.0, 1e-12];
        pass_through(&mut force, 40.0, 4e-8, &row(5));
        assert_eq!(force, [40.0, 40.0 * PASSED_ON, 10.0 * PASSED_ON, 10.0, 4e-8]);
        // Nothing beside it holds anything either.
        let mut force = [0.0, 0.0];
        pass_through(&mut force, 1.0, 1e-9, &row(2));
        assert_eq!(force, [1e-9, 1e-9]);
    }
}
