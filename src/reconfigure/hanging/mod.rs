//! Cheap proofs for states in which one module hangs on the others, whose connections do not
//! change while it walks over them.
//!
//! Fewer connections and contacts never make a structure stronger (statics: monotony). So the
//! state is at least as strong as one in which the module is held by a single other one, and that
//! falls into two parts that balance alone settles: what the two modules hold each other by
//! ([`grip`]), and the rest of the robot with the module's weight on the one that holds it ([`rest`]).
//!
//! The utilisation of the rest is a convex function of its loads (statics: convexity), and the weight's
//! wrench is linear in where it acts. So where the rest carries the weight at the corners of a
//! box, it carries it everywhere inside: a few questions stand for all states of a walk on one support.
//!
//! Knows structures; does not know which moves or plans ask. Shared by the planner
//! and the replay, like the oracle that it asks.

pub mod grip;
pub mod rest;

pub use grip::{Grip, best_grip};
pub use rest::{Reach, Rest, Rests};
