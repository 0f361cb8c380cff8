//! Actions, transient states, and the search space of a robot.

pub mod assembly;
mod surface;
