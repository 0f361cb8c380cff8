//! From where to where an attempt carries modules: from the start on, or from the goal back.
//!
//! Every move reverses, so that both make plans from the start to the goal. What is a dead end on one way may be none on
//! the other: the last module of a pit that cannot leave it any more is the first one that comes, beside one that is there.

use crate::reconfigure::layout::Layout;
use crate::reconfigure::moves::Move;
use crate::reconfigure::problem::Problem;
use crate::robot::{Cell, Placement};

use super::shape::{Targets, targets};

/// Which way modules are carried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the start on.
    Forwards,
    /// From the goal back: the plan does it in reverse.
    Backwards,
}

impl Direction {
    /// The plan's move for one on the way.
    pub fn planned(self, step: Move) -> Move {
        match self {
            Self::Forwards => step,
            Self::Backwards => step.inverse(),
        }
    }

    /// The cell that a move of the plan leads on from, on the way.
    pub fn origin(self, planned: Move) -> Cell {
        match self {
            Self::Forwards => planned.from,
            Self::Backwards => planned.to(),
        }
    }
}

/// Where an attempt begins and where it is to end.
#[derive(Clone, Debug)]
pub struct Journey {
    /// Which way it goes.
    pub direction: Direction,
    /// Where it begins.
    pub layout: Layout,
    /// Where each module of the start is then.
    pub placements: Vec<Placement>,
    /// Where modules are wanted.
    pub targets: Targets,
}

impl Journey {
    /// From the start to `goal`, and back where it does not matter how modules are turned.
    pub fn both(problem: &Problem, goal: &Layout) -> Vec<Self> {
        let start = problem.start_layout();
        let placements = problem.start().modules.iter().map(|module| module.placement).collect();
        let direction = Direction::Forwards;
        let mut both = vec![Self { direction, layout: start.clone(), placements, targets: targets(goal) }];
        if !problem.turns() {
            let (direction, placements) = (Direction::Backwards, problem.placements(goal));
            both.push(Self { direction, layout: goal.clone(), placements, targets: targets(start) });
        }
        both
    }
}
