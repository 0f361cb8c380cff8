//! Reconfiguration of robots outside lattices: chains, freeform robots, and mixtures.

mod action;
pub mod assembly;
#[cfg(test)]
mod assembly_tests;
pub mod replay;

pub use action::{Action, Half};
