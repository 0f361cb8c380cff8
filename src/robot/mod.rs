//! Robots as data: module types, catalogues, configurations, and what can be
//! said about them without forces: poses, occupied cells, touching faces,
//! connectedness, and everything that makes the data unsound.
//!
//! Knows poses and connector models; knows no search, no collision of solids,
//! no files.

mod built_in;
mod catalogue;
mod catalogue_check;
mod configuration;
mod configuration_check;
mod connection;
mod environment;
mod hull;
mod lattice;
pub mod linkage;
mod module_type;
mod module_type_check;
mod motion;
mod occupancy;
mod problem;
mod requirement;
mod shape;
mod stencil;
mod stencil_check;
mod terrain;
#[cfg(test)]
mod tests;

pub use built_in::{BUILT_IN, BUILT_IN_MOTIONS, rofi};
pub use catalogue::Catalogue;
pub use configuration::{Configuration, FaceConnection, Goal, Matching, Module, ModuleLoad, Port};
pub use connection::{Connection, OnModule};
pub use environment::{Environment, Ground, Obstacle};
pub use hull::{Hull, HullFace};
pub use lattice::{Cell, Face, Orientation, Placement, neighbour};
pub use module_type::{BodyType, JointType, LatticeType, ModuleType, PortPlace, PortType};
pub use motion::{Motion, Turn, axis_of_turn};
pub use occupancy::Occupancy;
pub use problem::{Fault, Part, Problem};
pub use requirement::{Region, Requirement};
pub use shape::{LARGEST, Shape, ShapeFault};
pub use stencil::{FARTHEST_CELL, MotionType, Stencil};
pub use terrain::{HeightField, MOST_HEIGHTS, MOST_TRIANGLES, Mesh, Terrain};
