//! What both search spaces of a robot share: moves that are free of collision,
//! connectedness, and margins as widths.

use planners::Width;

use crate::geometry::{Solid, Surroundings, first_collision};
use crate::robot::Placement;
use crate::statics::Bracket;

use super::course::motion;
use super::layout::{Bond, Layout};
use super::moves::{Move, fitting};
use super::oracle::{Oracle, Rest, Worst};
use super::problem::Problem;

/// A problem with everything that answers questions about its states.
pub struct Domain<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The oracle for its states.
    pub oracle: Oracle<'a>,
    /// Whether states must be stable at all.
    pub stability: bool,
    surroundings: Surroundings,
    pitch: f64,
}

impl<'a> Domain<'a> {
    /// Prepares for questions about a problem's states.
    pub fn new(problem: &'a Problem, stability: bool) -> Self {
        let start = problem.start();
        let surroundings = Surroundings {
            solids: start.environment.obstacles.iter().map(Solid::from).collect(),
            ground: start.environment.ground.as_ref().map(|ground| ground.height),
        };
        Self { problem, oracle: Oracle::new(start), stability, surroundings, pitch: start.pitch() }
    }

    /// The moves that fit among the modules and hit neither ground nor
    /// obstacles, in a fixed order, whatever is engaged.
    pub fn moves(&self, layout: &Layout) -> Vec<Move> {
        let mut moves = fitting(layout, |class| self.problem.ability(class));
        moves.retain(|&step| self.is_clear(layout, step));
        moves
    }

    fn is_clear(&self, layout: &Layout, step: Move) -> bool {
        let class = layout.placed()[layout.at(step.from).expect("a fitting move has a module")].class;
        let module_type = self.problem.class(class).module_type;
        let shape = self.problem.start().catalogue.module_types[module_type].body.shape.clone();
        // A cube sweeps the same room in every orientation.
        let solid = Solid::new(shape, Placement::new(step.from).pose(self.pitch));
        first_collision(&solid, &motion(step, self.pitch), &self.surroundings).is_none()
    }

    /// The layout after a move.
    pub fn after(&self, layout: &Layout, step: Move) -> Layout {
        let class = layout.placed()[layout.at(step.from).expect("a fitting move has a module")].class;
        step.applied(layout, self.problem.class(class).turns)
    }

    /// Whether a state at rest is connected, if it has to be.
    pub fn is_connected(&self, layout: &Layout, bonds: &[Bond]) -> bool {
        !self.problem.must_stay_connected() || layout.is_connected_by(bonds.iter().map(|bond| bond.cells()))
    }

    /// Whether the robot stays connected during a move and after it, if it has to.
    ///
    /// In the interior of a slide more holds than at either end, so the two
    /// ends decide. A pivot hangs on its hinge until it rests on its landing face.
    pub fn stays_connected(&self, layout: &Layout, bonds: &[Bond], step: Move) -> bool {
        // The moving module goes by the cell that it leaves.
        let others = || bonds.iter().filter(|bond| !bond.touches(step.from)).map(|bond| bond.cells());
        let holds = [step.departure(layout), step.landing(layout)];
        !self.problem.must_stay_connected()
            || holds.iter().all(|holds| {
                let own = holds.iter().map(|bond| bond.cells().map(|c| if c == step.to() { step.from } else { c }));
                layout.is_connected_by(others().chain(own))
            })
    }

    /// Margin at rest.
    pub fn of_state(&self, layout: &Layout, bonds: &[Bond]) -> Worst {
        self.oracle.of_state(&self.problem.placements(layout), bonds)
    }

    /// Margin of a move out of a state with these connections.
    pub fn of_move(&self, layout: &Layout, bonds: &[Bond], step: Move, floor: f64) -> Worst {
        let after = self.after(layout, step);
        let rest = Rest { placements: self.problem.placements(&after), bonds: bonds_after(layout, bonds, step) };
        self.oracle.of_move(self.problem.placements(layout), bonds, step, &rest, floor)
    }
}

/// The connections after a move, ascending.
pub fn bonds_after(layout: &Layout, bonds: &[Bond], step: Move) -> Vec<Bond> {
    let others = bonds.iter().copied().filter(|bond| !bond.touches(step.from));
    let mut after: Vec<Bond> = others.chain(step.landing(layout)).collect();
    after.sort_unstable();
    after
}

/// A margin as a width.
pub fn width(margin: Bracket) -> Width {
    Width { lower: margin.lower, upper: margin.upper }
}
