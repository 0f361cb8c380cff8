//! Reconfiguration of robots outside lattices: chains, freeform robots, and mixtures.

pub mod assembly;
#[cfg(test)]
mod assembly_tests;
