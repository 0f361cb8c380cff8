//! Chains: series of links over bodies that nothing else holds.
//!
//! Whatever their length, one unknown wrench runs through all of their links.
//! Knows where a block's chains are and how wrenches pass along them, nothing of
//! how stiff they are.

use nalgebra::{Matrix3, Matrix6, SMatrix};
use smallvec::SmallVec;

use crate::spatial::Vec3;

use super::frame::LinkFrame;
use super::maps::{Side, Sides};
use super::program::Program;
use super::series::Stacked;

/// Bodies of a chain from which on it is condensed: shorter ones are eliminated
/// faster than they are added up, and lose nothing.
const LONG: usize = 8;

/// A junction, by number, and the action on its balance of the wrench that arrives
/// there; `None` on the ground.
pub(super) type End<const D: usize> = Option<(usize, SMatrix<f64, D, D>)>;

/// A series of links from one junction, or the ground, to another, over bodies that
/// nothing else holds.
pub(super) struct Chain<const D: usize> {
    pub links: Vec<Passage<D>>,
    /// Bodies between the links, one fewer than links.
    pub bodies: Vec<Between<D>>,
    /// The junctions at the two ends, with the wrench that runs through the chain.
    pub ends: [End<D>; 2],
    /// Root of the stiffness between the ends, and in a chain of several the root
    /// of every link's flexibility, all for the wrench in the first link's frame.
    pub root: SMatrix<f64, D, D>,
    pub flexibility: Vec<SMatrix<f64, D, D>>,
    /// How the roots were stacked: from the flexibilities before each link and its
    /// own to those up to it.
    pub stacked: Vec<Stacked<D>>,
}

/// A link of a chain: its index, and its wrench when that of the first link is 1.
pub(super) struct Passage<const D: usize> {
    pub link: usize,
    pub wrench: SMatrix<f64, D, D>,
}

/// A body of a chain: its index, and the wrench, in the first link's frame, that
/// a load on its scaled balance rows adds to the links behind it.
pub(super) struct Between<const D: usize> {
    pub body: usize,
    pub load: SMatrix<f64, D, D>,
}

/// Whether there are chains worth condensing.
pub(super) fn has_long_chains(program: &Program) -> bool {
    within_chains(program, &incident(program)).contains(&true)
}

/// The links at each body.
pub(super) fn incident(program: &Program) -> Vec<SmallVec<[usize; 4]>> {
    let mut incident = vec![SmallVec::new(); program.scales.force.len()];
    for (link, sides) in program.sides.iter().enumerate() {
        for side in sides.iter().flatten() {
            incident[side.body].push(link);
        }
    }
    incident
}

/// Which bodies hang between two links of a long chain each.
pub(super) fn within_chains(program: &Program, incident: &[SmallVec<[usize; 4]>]) -> Vec<bool> {
    let passes = |links: &SmallVec<[usize; 4]>| {
        links.len() == 2 && links[0] != links[1] && links.iter().all(|&link| program.in_series[link])
    };
    let mut within: Vec<bool> = incident.iter().map(passes).collect();
    let mut seen = vec![false; within.len()];
    for body in 0..within.len() {
        if !within[body] || seen[body] {
            continue;
        }
        seen[body] = true;
        let mut run = vec![body];
        let mut next = 0;
        while let Some(&at) = run.get(next) {
            next += 1;
            for side in incident[at].iter().flat_map(|&link| program.sides[link].iter().flatten()) {
                if within[side.body] && !seen[side.body] {
                    seen[side.body] = true;
                    run.push(side.body);
                }
            }
        }
        if run.len() < LONG {
            for body in run {
                within[body] = false;
            }
        }
    }
    within
}

/// Follows the chain that begins with `link` at its side `start`.
pub(super) fn walk(
    program: &Program,
    junction: &[Option<usize>],
    incident: &[SmallVec<[usize; 4]>],
    used: &mut [bool],
    link: usize,
    start: usize,
) -> Chain<6> {
    let first = &program.frames[link];
    // Sign of the first link's wrench when it runs through the current one.
    let mut through = 1.0;
    let end = |side: &Option<Side>, through: f64| {
        side.as_ref().and_then(|side| Some((junction[side.body]?, action(program, first, side, through))))
    };
    let begin = end(&program.sides[link][start], 1.0);
    let (mut links, mut bodies) = (Vec::new(), Vec::new());
    let (mut at, mut leaving) = (link, 1 - start);
    loop {
        used[at] = true;
        links.push(Passage { link: at, wrench: passage(first, &program.frames[at]) * through });
        let side = program.sides[at][leaving];
        let between = side.filter(|side| junction[side.body].is_none());
        let Some(side) = between else {
            let ends = [begin, end(&side, through)];
            return Chain { links, bodies, ends, root: Matrix6::zeros(), flexibility: Vec::new(), stacked: Vec::new() };
        };
        let next = incident[side.body].iter().copied().find(|&other| other != at).expect("it has two links");
        let sides: &Sides = &program.sides[next];
        let entered = sides.iter().position(|s| s.is_some_and(|s| s.body == side.body)).expect("it ends here");
        let sign = sides[entered].expect("just found").sign;
        through *= -side.sign / sign;
        bodies.push(Between { body: side.body, load: reaction(program, first, side.body, sign * through) });
        (at, leaving) = (next, 1 - entered);
    }
}

/// The wrench in the frame `to` of a wrench in the frame `from`.
fn passage(from: &LinkFrame, to: &LinkFrame) -> Matrix6<f64> {
    let turn = to.axes.tr_mul(&from.axes);
    let lever = to.axes.tr_mul(&((from.origin - to.origin).cross_matrix() * from.axes));
    blocks(&turn, &lever)
}

/// What the wrench in the frame `first` adds to the balance rows at `side`, `through` times.
fn action(program: &Program, first: &LinkFrame, side: &Side, through: f64) -> Matrix6<f64> {
    let mut map = blocks(&first.axes, &((first.origin - com(program, side.body)).cross_matrix() * first.axes));
    for (row, factor) in program.row_factor[6 * side.body..6 * side.body + 6].iter().enumerate() {
        map.row_mut(row).scale_mut(side.sign * through * factor);
    }
    map
}

/// The inverse of an [`action`] with the sign `sign`.
fn reaction(program: &Program, first: &LinkFrame, body: usize, sign: f64) -> Matrix6<f64> {
    let turn = first.axes.transpose();
    let mut map = blocks(&turn, &(turn * (com(program, body) - first.origin).cross_matrix()));
    for (column, factor) in program.row_factor[6 * body..6 * body + 6].iter().enumerate() {
        map.column_mut(column).scale_mut(sign / factor);
    }
    map
}

fn com(program: &Program, body: usize) -> Vec3 {
    program.coms[body]
}

/// `[turn 0; lever turn]`.
fn blocks(turn: &Matrix3<f64>, lever: &Matrix3<f64>) -> Matrix6<f64> {
    let mut map = Matrix6::zeros();
    map.fixed_view_mut::<3, 3>(0, 0).copy_from(turn);
    map.fixed_view_mut::<3, 3>(3, 0).copy_from(lever);
    map.fixed_view_mut::<3, 3>(3, 3).copy_from(turn);
    map
}
