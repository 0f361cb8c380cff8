//! Repairs a twist field that a few links do not admit.
//!
//! A link's *reserve* is how much more it opens than it slips; the link admits a
//! relative twist where that is not negative. It is a concave and positively
//! homogeneous function of the twists, so
//! `reserve(v + e b) >= reserve(v) + e reserve(b)`: of a field b that every link
//! admits with something to spare, the least sufficient share e is found link by
//! link. Expansion from a point behind the supports ("breathing") is such a field
//! for most structures: all parts move away from each other and from what holds them.

use crate::spatial::{Twist, Vec3};

use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::Model;
use super::super::second_order::norm;

/// Depth of the apex behind the supports over the distance of the farthest body.
const DEPTH: f64 = 2.0;

/// Reserve, relative to the fastest body, that every link should have: more than
/// the rounding that the bracket subtracts.
const LEAST: f64 = 1e-12;

/// Excess of the share over what the formula asks for: rounding.
const EXCESS: f64 = 1.0 + 1e-6;

/// The expansion of the block's bodies from a point behind its supports: the
/// body farthest from them moves at about 1 m/s.
fn breathing(problem: &Problem<'_>) -> Vec<Twist> {
    let Problem { structure, block, program, .. } = *problem;
    let (mut middle, mut inward, mut count) = (Vec3::zeros(), Vec3::zeros(), 0.0_f64);
    for (frame, ends) in program.frames.iter().zip(&program.ends) {
        if let Some(sign) = match ends {
            [Some(_), None] => Some(1.0),
            [None, Some(_)] => Some(-1.0),
            _ => None,
        } {
            middle += frame.origin;
            inward += frame.axes.column(2) * sign;
            count += 1.0;
        }
    }
    middle /= count.max(1.0);
    let com = |body: usize| structure.bodies[body].com;
    let far = block.bodies.iter().map(|&body| (com(body) - middle).norm()).fold(f64::MIN_POSITIVE, f64::max);
    let apex = middle - inward.try_normalize(0.0).unwrap_or_else(Vec3::zeros) * (DEPTH * far);
    block.bodies.iter().map(|&body| Twist::new((com(body) - apex) / far, Vec3::zeros())).collect()
}

fn fastest(twists: &[Twist]) -> f64 {
    twists.iter().map(|twist| twist.linear.norm()).fold(0.0, f64::max)
}

/// The least shares of fields that open links which make every link admit some twists.
pub(super) struct Opening<'p> {
    problem: Problem<'p>,
    by: Vec<Twist>,
    gains: Vec<f64>,
}

impl<'p> Opening<'p> {
    /// By a share of `by`.
    pub(super) fn new(problem: &Problem<'p>, by: Vec<Twist>) -> Self {
        Self { problem: *problem, gains: reserves(problem, &by), by }
    }

    /// By a share of breathing.
    pub(super) fn breathing(problem: &Problem<'p>) -> Self {
        Self::new(problem, breathing(problem))
    }

    /// Adds the least share to `twists` that makes every link admit them; whether there is one.
    pub(super) fn open(&self, twists: &mut [Twist]) -> bool {
        let wanted = LEAST * fastest(twists);
        let mut share = 0.0_f64;
        for (reserve, gain) in reserves(&self.problem, twists).iter().zip(&self.gains) {
            let lacking = wanted - reserve;
            if lacking > 0.0 {
                if !(*gain > 0.0) {
                    return false;
                }
                share = share.max(lacking / gain);
            }
        }
        if share > 0.0 {
            share *= EXCESS;
            for (twist, more) in twists.iter_mut().zip(&self.by) {
                twist.linear += more.linear * share;
                twist.angular += more.angular * share;
            }
        }
        true
    }
}

/// How much more every link opens than it slips, in m/s; infinite for links that
/// hold by equations or not at all, which opening does not help.
fn reserves(problem: &Problem<'_>, twists: &[Twist]) -> Vec<f64> {
    let Problem { structure, block, program, .. } = *problem;
    let reserve = |(l, &link): (usize, &Link)| {
        let relative = program.relative_twist(l, twists);
        let Twist { linear: v, angular: w } = relative;
        let at_point = |x: f64, y: f64, friction: f64| {
            let v = relative.at(&Vec3::new(x, y, 0.0));
            v.z - friction * v.xy().norm()
        };
        match link {
            Link::Contact(i) => at_point(0.0, 0.0, structure.contacts[i].friction),
            Link::Connection(i) => match &structure.connectors[structure.connections[i].connector].model {
                Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                    v.z - norm(&[a * v.x, b * v.y, c * w.x, d * w.y, e * w.z])
                }
                Model::Box { compression, .. } if compression.is_infinite() => v.z,
                Model::Box { .. } => f64::INFINITY,
                Model::Patch { friction, points } => {
                    points.iter().map(|p| at_point(p[0], p[1], *friction)).fold(f64::INFINITY, f64::min)
                }
            },
        }
    };
    block.links.iter().enumerate().map(reserve).collect()
}
