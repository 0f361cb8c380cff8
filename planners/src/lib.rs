//! Lazy search over implicit weighted graphs.
//!
//! The graph is a [`Space`]. Every transition has an additive cost and a
//! width; the width of a path is its narrowest transition. Widths are
//! expensive to know, so they are bounded cheaply first and certified on demand.

mod space;

pub use space::{Space, Transition, Width};
