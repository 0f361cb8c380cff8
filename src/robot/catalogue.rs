//! Module types and the connectors they carry.

use crate::spatial::Vec3;
use crate::statics::{Connector, Model};

use super::shape::Shape;

/// One rigid body of a module type.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyType {
    /// Name within the module type.
    pub name: String,
    /// Mass in kg.
    pub mass: f64,
    /// Centre of mass in the module frame, in m.
    pub com: Vec3,
    /// Solid, centred on the module frame.
    pub shape: Shape,
}

/// What makes a module type a lattice module: cubes that dock face to face.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeType {
    /// Edge length of a cell in m.
    pub pitch: f64,
    /// Connector on every face: index into [`Catalogue::connectors`]. A patch
    /// connector without points takes the corners of the face it sits on.
    pub face: usize,
    /// Connector that holds the module at a shared edge while it pivots, z
    /// along the edge: index into [`Catalogue::connectors`].
    pub hinge: Option<usize>,
    /// Whether it can slide over the faces of two coplanar neighbours.
    pub slide: bool,
    /// Whether it can pivot about an edge shared with a neighbour.
    pub pivot: bool,
}

/// A kind of module.
#[derive(Clone, Debug, PartialEq)]
pub struct ModuleType {
    /// Name that configurations use.
    pub name: String,
    /// Its one rigid body.
    pub body: BodyType,
    /// How it sits in the lattice, docks and moves.
    pub lattice: LatticeType,
}

/// A set of module types with their connectors.
#[derive(Clone, Debug, PartialEq)]
pub struct Catalogue {
    /// Name (of a built-in) or where it was read from.
    pub name: String,
    /// Connector models.
    pub connectors: Vec<Connector>,
    /// Module types.
    pub module_types: Vec<ModuleType>,
}

impl Catalogue {
    /// The connector that holds two faces together, of modules of these types:
    /// of the two faces' connectors the one of smaller strength (the first
    /// type's if equal), as an index into [`Catalogue::connectors`]. `None`
    /// when their models differ, so that they do not fit. The catalogue must be sound.
    pub fn face_connector(&self, first: usize, second: usize) -> Option<usize> {
        let face = |module_type: usize| self.module_types[module_type].lattice.face;
        let (a, b) = (face(first), face(second));
        let (ca, cb) = (&self.connectors[a], &self.connectors[b]);
        let same_model = matches!(
            (&ca.model, &cb.model),
            (Model::Cone { .. }, Model::Cone { .. })
                | (Model::Box { .. }, Model::Box { .. })
                | (Model::Patch { .. }, Model::Patch { .. })
        );
        same_model.then_some(if cb.strength < ca.strength { b } else { a })
    }

    /// The hinge that holds a module while it pivots about an edge shared with
    /// a supporter, as an index into [`Catalogue::connectors`]: the one of
    /// smaller strength of the two modules' hinges, the pivoting one's if
    /// equal. `None` when either has no hinge.
    pub fn hinge(&self, pivoting: usize, supporter: usize) -> Option<usize> {
        let hinge = |module_type: usize| self.module_types[module_type].lattice.hinge;
        let (a, b) = (hinge(pivoting)?, hinge(supporter)?);
        Some(if self.connectors[b].strength < self.connectors[a].strength { b } else { a })
    }

    /// The module type that configurations call `name`, as an index into
    /// [`Catalogue::module_types`].
    pub fn find(&self, name: &str) -> Option<usize> {
        self.module_types.iter().position(|module_type| module_type.name == name)
    }
}
