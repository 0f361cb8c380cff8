//! Robots as data: module types, catalogues, configurations.
//!
//! Knows poses and connector models; knows no search, no collision, no files.

mod catalogue;
mod configuration;
mod lattice;

pub use catalogue::{BodyType, Catalogue, LatticeType, ModuleType, Shape};
pub use configuration::{
    Configuration, Environment, FaceConnection, Goal, Ground, Matching, Module, ModuleLoad, Obstacle, Port, Requirement,
};
pub use lattice::{Cell, Face, Orientation, Placement};
