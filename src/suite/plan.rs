//! A plan of either kind of robot, with the report that it came in.

use crate::generate::Pair;
use crate::reconfigure::linkage::assembly::Held;
use crate::reconfigure::{Report, linkage};

/// What a search answered.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyPlan {
    /// For cubes.
    Lattice(Box<Report>),
    /// For a linkage.
    Linkage(Box<Report<linkage::Action, Held>>),
}

impl AnyPlan {
    /// Whether it is an answer for robots of this kind.
    pub fn fits(&self, pair: &Pair) -> bool {
        matches!((self, pair), (Self::Lattice(_), Pair::Lattice { .. }) | (Self::Linkage(_), Pair::Linkage { .. }))
    }
}
