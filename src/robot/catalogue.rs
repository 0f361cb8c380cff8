//! Module types with the connectors they carry and the motions that they make.

use crate::statics::{Connector, Model};

use super::module_type::ModuleType;
use super::stencil::MotionType;

/// A set of module types with their connectors and motions.
#[derive(Clone, Debug, PartialEq)]
pub struct Catalogue {
    /// Name (of a built-in) or where it was read from.
    pub name: String,
    /// Connector models.
    pub connectors: Vec<Connector>,
    /// What lattice modules may be capable of.
    pub motions: Vec<MotionType>,
    /// Module types.
    pub module_types: Vec<ModuleType>,
}

impl Catalogue {
    /// The connector that holds two faces together, of modules of these types:
    /// of the two faces' connectors the one of smaller strength (the first
    /// type's if equal), as an index into [`Catalogue::connectors`]. `None`
    /// when their models differ, so that they do not fit. The catalogue must be sound.
    pub fn face_connector(&self, first: usize, second: usize) -> Option<usize> {
        let face = |module_type: usize| self.module_types[module_type].cell().face;
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
        let hinge = |module_type: usize| self.module_types[module_type].cell().hinge;
        let (a, b) = (hinge(pivoting)?, hinge(supporter)?);
        Some(if self.connectors[b].strength < self.connectors[a].strength { b } else { a })
    }

    /// The motion that plans call `name`, as an index into [`Catalogue::motions`].
    pub fn find_motion(&self, name: &str) -> Option<usize> {
        self.motions.iter().position(|motion| motion.name == name)
    }

    /// The module type that configurations call `name`, as an index into
    /// [`Catalogue::module_types`].
    pub fn find(&self, name: &str) -> Option<usize> {
        self.module_types.iter().position(|module_type| module_type.name == name)
    }
}
