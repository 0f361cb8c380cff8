//! Certificates: a bracket with the two fields that prove it, and their checker.
//!
//! # What is claimed
//!
//! The utilisation of a structure is
//!
//! ```text
//! t* = min t   subject to   balance of every free body,
//!                           |f_t| <= mu f_n at every contact,
//!                           s_l(w_l) <= t S_l for every connection,   t >= 0
//! ```
//!
//! and a certificate claims `lower <= t* <= upper`, with the verdict that follows.
//!
//! # What proves it
//!
//! - **From above**, a [`Stress`]: forces that balance every free body within the
//!   friction cones. Its largest demand `s_l / S_l` is at least t*. Doubles never
//!   balance exactly. What every body lacks is enclosed in an interval and carried
//!   along a forest of connections to the ground, as an uncertainty of their
//!   wrenches, and every demand is evaluated for the worst wrench: no error term is
//!   assumed.
//! - **From below**, a [`Mechanism`]: velocities that open every contact,
//!   `v_n >= mu |v_t|`, and against which no connection resists without limit. By
//!   virtual power the loads' power is at most `t*` times what the connections
//!   dissipate at their rated strengths, so their ratio is at most t*. If nothing
//!   is dissipated, whatever the strengths, and the loads work, the structure is
//!   whole-body unstable.
//!
//! Everything is evaluated in [intervals](interval) that are rounded outwards. Where
//! no chain of connections leads to the ground there is no exact balance in doubles:
//! there, as everywhere in this crate, **data count as meant up to a relative 1e-12**
//! ([`DATA`]), and [`Proof::forgiven`] says how much of that was needed.
//!
//! # Reading order
//!
//! This page, [`interval`], `models` (what the connectors do; `face` for one of them),
//! `balance` (the bound from above; `forest`, `loads` and `allowance` for what rounding
//! leaves), `motion` (the bound from below), `check` (claims against proofs) and `sound`
//! (data that mean nothing): together the checker, which shares no code with the solver.
//! `issue` makes a certificate from an answer of the oracle and is not to be trusted.
//! Knows no files, no robots and nothing of how the fields were found.

mod allowance;
mod balance;
mod check;
mod face;
mod forest;
pub mod interval;
mod issue;
mod loads;
mod models;
mod motion;
mod sound;

pub use check::{Fault, Proof, check};
pub use issue::{Uncertified, issue};

use crate::spatial::{Twist, Vec3, Wrench};
use crate::statics::{Bracket, Structure, Verdict};

/// Relative accuracy to which loads, friction and directions are taken to be meant
/// (dimensionless): decimal input rounded to binary can say no more.
pub const DATA: f64 = 1e-12;

/// A claim about a structure with its proof. It stands on its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// What it is about.
    pub structure: Structure,
    /// The verdict, which must follow from the bracket.
    pub verdict: Verdict,
    /// The utilisation; both ends infinite when whole-body unstable.
    pub utilisation: Bracket,
    /// Proof of a finite upper end.
    pub stress: Option<Stress>,
    /// Proof of a lower end above 0.
    pub mechanism: Option<Mechanism>,
}

/// Forces that hold the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Stress {
    /// What each connection carries, in the structure's order.
    pub connections: Vec<Carried>,
    /// Force in N on each contact's `body`, in W, in the structure's order.
    pub contacts: Vec<Vec3>,
}

/// What a connection carries.
#[derive(Clone, Debug, PartialEq)]
pub enum Carried {
    /// Through a cone or a box: the wrench on the child at the connection point, in
    /// the connection frame.
    Wrench(Wrench),
    /// Through a patch: forces on the child, in the connection frame, that add up to
    /// the wrench once the preload is subtracted.
    Points {
        /// Preload s in N, not negative.
        preload: f64,
        /// Force in N at each of the face's points.
        forces: Vec<Vec3>,
    },
}

/// A motion in which the structure fails.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The one point in W, in m, that all twists refer to: bodies that move as one
    /// have the same twist, bit for bit, so that nothing moves between them, exactly.
    pub about: Vec3,
    /// Twist of each body in W, in the structure's order; zero for fixed bodies.
    pub twists: Vec<Twist>,
}
