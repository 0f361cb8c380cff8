//! The range of a force that a structure withstands, as a question of its own.
//!
//! With a force of `lambda` newtons along a line added to the loads, the utilisation t* is a
//! convex function of `lambda`, so the structure stands on an interval,
//!
//! ```text
//! max / min lambda   subject to   balance under L + lambda e,
//!                                 friction cones, s_l(w_l) <= u S_l,
//! ```
//!
//! with u the limit on the utilisation (1, or 1 less a margin that is to be left). Each end is
//! one cone program, not a search: divided by `lambda`, with `tau = 1 / lambda`, it reads
//!
//! ```text
//! min tau   subject to   balance under e + tau L, friction cones, s_l(w_l) <= tau u S_l,
//! ```
//!
//! which has the form of the utilisation's own program (`reach`). What the solver returns is not
//! believed. An end is a bracket: the inner side is a force whose wrenches balance and hold, the
//! outer one follows from a motion in which every contact opens,
//!
//! ```text
//! lambda <= (u dissipation - power of L) / (power of e),
//! ```
//!
//! or is a force that no strength, or not enough of it, withstands (`polish`). An end is
//! infinite where the force alone demands nothing of any connection: added to what stands, any
//! multiple of it stands. Where the loads alone are too much, or nearly so, a rod of unlimited
//! strength along the line finds the force that helps most (`rod`); if that is not enough, no
//! force is.
//!
//! Knows one force at a time and nothing of robots.

mod line;
mod polish;
mod reach;
mod rod;

use crate::spatial::Vec3;

use super::assessment::{Assessment, Bracket, Question, Verdict};
use super::structure::Structure;
use super::validate::{InvalidStructure, validate};

use line::Line;
use reach::Reach;

/// A force of 1 N whose factor is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitForce {
    /// Index of the body it acts on.
    pub body: usize,
    /// Its direction in W, of any length but zero.
    pub direction: Vec3,
    /// Its point of action in W, in m; the centre of mass when `None`.
    pub at: Option<Vec3>,
}

/// One end of the interval.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeEnd {
    /// Bracket in N on the end: the side towards the interval is proved to be withstood, what lies
    /// beyond the other one is proved not to be. Both sides infinite: no force in this
    /// direction is too much, as far as rigid bodies go. An infinite outer side alone: where it ends is not decided.
    pub force: Bracket,
    /// The state just beyond the end: its critical connections and its mechanism are what
    /// fails there. `None` where there is no end, or none that was found.
    pub beyond: Option<Box<Assessment>>,
    /// What an error in N is measured by.
    size: f64,
}

impl RangeEnd {
    /// Whether the end is known to [`RANGE_GAP`], or is known not to exist.
    pub fn is_decided(&self) -> bool {
        self.force.width() <= RANGE_GAP * self.size
    }

    /// Whether it is proved that there is no end.
    pub fn is_unlimited(&self) -> bool {
        self.force.lower == self.force.upper && self.force.lower.is_infinite()
    }
}

/// The forces along a line that a structure withstands.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadRange {
    /// Those between two ends, the first of which is not above the second.
    Between {
        /// The least force; negative is against the direction.
        lowest: RangeEnd,
        /// The largest force.
        highest: RangeEnd,
    },
    /// None: the structure does not stand without the force, and no force along the line helps.
    Nowhere {
        /// What is proved with the force left free: the bracket on the least utilisation over all
        /// forces, its critical connections and mechanism.
        best: Box<Assessment>,
    },
    /// Neither is proved.
    Undecided {
        /// Why.
        because: String,
    },
}

impl LoadRange {
    /// Whether the structure stands under so much of the force; `None` where that is not known.
    pub fn contains(&self, force: f64) -> Option<bool> {
        match self {
            Self::Between { lowest, highest } => {
                let (low, high) = (lowest.force, highest.force);
                let inside = low.upper <= force && force <= high.lower;
                let outside = force < low.lower || force > high.upper;
                (inside || outside).then_some(inside)
            }
            Self::Nowhere { .. } => Some(false),
            Self::Undecided { .. } => None,
        }
    }
}

/// Width of an end's bracket that counts as known, as a share of the larger of the forces of the
/// range and a thousandth of those that the structure is made for.
pub const RANGE_GAP: f64 = 1e-6;

/// Share of the limit up to which the loads alone are a good place to start from.
const COMFORTABLE: f64 = 0.9;

/// Accuracy of the utilisation at the start, which only interpolation depends on.
const ROUGH: Question = Question::ToGap(1e-3);

/// The forces along a line that `structure` withstands with a utilisation of at most `limit`: 1, or
/// 1 less the margin that is to be left.
///
/// ```
/// use steadfast::spatial::{Pose, Rotation, Vec3};
/// use steadfast::statics::{
///     Anchor, Body, Connection, Connector, LoadRange, Model, Structure, UnitForce, load_range,
/// };
///
/// // One kilogram hangs from a magnet of 100 N: it can be pulled down by 90.19 N more, and
/// // pushed up without end.
/// let structure = Structure {
///     gravity: Vec3::new(0.0, 0.0, -9.81),
///     bodies: vec![Body { mass: 1.0, com: Vec3::new(0.0, 0.0, -0.1), fixed: false }],
///     connectors: vec![Connector {
///         name: "magnet".into(),
///         strength: 100.0,
///         model: Model::Cone { friction: [0.8; 2], radius: [0.02; 3] },
///     }],
///     connections: vec![Connection {
///         parent: Anchor::World,
///         child: Anchor::Body(0),
///         connector: 0,
///         frame: Pose::from_parts(
///             Vec3::zeros().into(),
///             Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI),
///         ),
///     }],
///     ..Structure::default()
/// };
/// let down = UnitForce { body: 0, direction: -Vec3::z(), at: None };
/// let LoadRange::Between { lowest, highest } = load_range(&structure, &down, 1.0).unwrap() else { panic!() };
/// assert!(lowest.is_unlimited());
/// assert!((highest.force.upper - 90.19).abs() < 1e-4 && (highest.force.lower - 90.19).abs() < 1e-4);
/// ```
///
/// # Errors
/// As for [`assess`](super::assess()); a body that is not there, a direction or point that is not
/// finite, no direction, a limit that is not finite and positive.
pub fn load_range(structure: &Structure, force: &UnitForce, limit: f64) -> Result<LoadRange, Vec<InvalidStructure>> {
    validate(structure)?;
    refuse(structure, force, limit)?;
    let line = Line::new(structure, force);
    let alone = line.assess(0.0, ROUGH);
    let mut start = Start { force: 0.0, utilisation: alone.utilisation.upper };
    if !(start.utilisation <= COMFORTABLE * limit) {
        let best = rod::least(&line);
        if best.verdict == Verdict::WholeBodyUnstable || best.utilisation.lower > limit {
            return Ok(LoadRange::Nowhere { best: Box::new(best) });
        }
        let helpful = rod::force(&best);
        let utilisation = line.assess(helpful, Question::VALUE).utilisation.upper;
        if utilisation < start.utilisation {
            start = Start { force: helpful, utilisation };
        }
    }
    if !(start.utilisation <= limit) {
        let because = format!(
            "no force was found with which a utilisation of at most {limit} is proved: at {} N it is at most {}",
            start.force, start.utilisation
        );
        return Ok(LoadRange::Undecided { because });
    }
    let lowest = end(&line, &start, -1.0, limit);
    let highest = end(&line, &start, 1.0, limit);
    Ok(LoadRange::Between { lowest, highest })
}

/// A force that is withstood, with what it is proved to need at most.
struct Start {
    force: f64,
    utilisation: f64,
}

fn end(line: &Line<'_>, start: &Start, sign: f64, limit: f64) -> RangeEnd {
    let mut reach = reach::reach(line, start, sign, limit);
    if reach.outer.is_infinite() && line.demands_nothing(sign) {
        return RangeEnd { force: Bracket::exact(sign * f64::INFINITY), beyond: None, size: reach.size(start) };
    }
    polish::polish(line, start, sign, limit, &mut reach);
    // Each is proved up to the tolerance on data; where they cross by that, the truth lies between them.
    let [near, far] = [reach.inner.min(reach.outer), reach.inner.max(reach.outer)];
    let (inner, outer) = (start.force + sign * near, start.force + sign * far);
    let force = if sign > 0.0 { Bracket::new(inner, outer) } else { Bracket::new(outer, inner) };
    let beyond = beyond(line, start, sign, &reach, limit).map(Box::new);
    RangeEnd { force, beyond, size: reach.size(start) }
}

/// What fails a little beyond an end: as little as the oracle can tell.
fn beyond(line: &Line<'_>, start: &Start, sign: f64, reach: &Reach, limit: f64) -> Option<Assessment> {
    const BEYOND: [f64; 3] = [1e-6, 1e-4, 1e-2];
    if !reach.outer.is_finite() {
        return None;
    }
    BEYOND.iter().find_map(|share| {
        let step = reach.outer + share * reach.size(start);
        let answer = line.assess(start.force + sign * step, Question::VALUE);
        (answer.verdict == Verdict::WholeBodyUnstable || answer.utilisation.lower > limit).then_some(answer)
    })
}

fn refuse(structure: &Structure, force: &UnitForce, limit: f64) -> Result<(), Vec<InvalidStructure>> {
    let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
    let length = force.direction.norm();
    let checks = [
        (force.body < structure.bodies.len(), "force.body", "there is no such body"),
        (length.is_finite() && length > 0.0, "force.direction", "must be finite and not zero"),
        (force.at.as_ref().is_none_or(finite), "force.at", "is not finite"),
        (limit.is_finite() && limit > 0.0, "limit", "must be finite and positive"),
    ];
    let wrong = checks.into_iter().filter(|(holds, ..)| !holds);
    let found: Vec<_> = wrong
        .map(|(_, place, problem)| InvalidStructure { place: place.to_owned(), problem: problem.to_owned() })
        .collect();
    if found.is_empty() { Ok(()) } else { Err(found) }
}
