//! Actions, transient states, and the search space of a robot.

pub mod assembly;
#[cfg(test)]
mod assembly_laws;
#[cfg(test)]
mod assembly_tests;
mod surface;
