//! Between the plans of `reconfigure`, which are counted in cells, and those
//! of files, which also say about which axis a module turns and how far.

use std::fmt;

use super::document::{
    PlanBottleneck, PlanDocument, PlanObjective, PlanOutcome, PlanProof, PlanSequence, PlanStatistics, PlannedAction,
    PlannedStep, Problem,
};
use crate::reconfigure::{self, Action, Bottleneck, Objective, Outcome, Plan, Report};
use crate::robot::{Cell, Configuration, Face, FaceConnection};

/// An action that contradicts itself: its axis or angle is not that of the
/// turn from where the module is to where the action says it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// Index of the action.
    pub action: usize,
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "action {}: the module does not get there by the turn that is given", self.action)
    }
}

impl std::error::Error for Contradiction {}

impl PlanDocument {
    /// What a search answered to a problem.
    pub fn new(problem: Problem, report: &Report) -> Self {
        let plans = report.plan.iter().chain(&report.alternatives);
        let bounded = report.proof.margin_at_most.is_finite();
        Self {
            outcome: match report.outcome {
                Outcome::Solved => PlanOutcome::Solved,
                Outcome::Impossible(_) => PlanOutcome::Impossible,
                Outcome::OutOfBudget(_) => PlanOutcome::OutOfBudget,
            },
            objective: match report.objective {
                Objective::Margin => PlanObjective::Margin,
                Objective::Moves => PlanObjective::Moves,
            },
            proof: PlanProof {
                optimal: report.proof.optimal,
                margin_at_most: bounded.then_some(report.proof.margin_at_most),
                moves_at_least: Some(report.proof.moves_at_least as usize),
            },
            plans: plans.map(|plan| PlanSequence::new(&problem.start, plan)).collect(),
            problem,
            statistics: PlanStatistics {
                expanded: report.statistics.expanded,
                oracle_solves: report.statistics.oracle_solves,
                decided_by_bounds: report.statistics.decided_by_bounds(),
                seconds: report.statistics.seconds,
            },
        }
    }
}

impl PlanSequence {
    /// A plan that begins at `start`.
    pub fn new(start: &Configuration, plan: &Plan) -> Self {
        let mut cells = cells(start);
        let step = |planned: &reconfigure::PlannedAction| {
            let action = with_turn(&mut cells, planned.action);
            PlannedStep { action, margin: planned.margin }
        };
        let bottleneck = plan.bottleneck.as_ref().map(|bottleneck| PlanBottleneck {
            action: bottleneck.action,
            phase: bottleneck.phase,
            connection: bottleneck.connection.map(|connection| connection.ports),
        });
        Self {
            actions: plan.actions.iter().map(step).collect(),
            margin: plan.margin,
            moves: plan.moves as usize,
            bottleneck,
        }
    }

    /// The plan to replay from `start`.
    ///
    /// # Errors
    /// An action that contradicts itself.
    pub fn to_plan(&self, start: &Configuration) -> Result<Plan, Contradiction> {
        let mut cells = cells(start);
        let convert = |(index, step): (usize, &PlannedStep)| {
            let action = match step.action {
                PlannedAction::Attach([a, b]) => Action::Attach(FaceConnection::new(a, b)),
                PlannedAction::Detach([a, b]) => Action::Detach(FaceConnection::new(a, b)),
                PlannedAction::Slide { module, to } => Action::Slide { module, to },
                PlannedAction::Pivot { module, support, to, .. } => Action::Pivot { module, support, to },
            };
            match (step.action, with_turn(&mut cells, action)) {
                (given @ PlannedAction::Pivot { .. }, actual) if given != actual => {
                    Err(Contradiction { action: index })
                }
                _ => Ok(reconfigure::PlannedAction { action, margin: step.margin, phase: None }),
            }
        };
        let actions = self.actions.iter().enumerate().map(convert).collect::<Result<_, _>>()?;
        let bottleneck = self.bottleneck.map(|bottleneck| Bottleneck {
            action: bottleneck.action,
            phase: bottleneck.phase,
            connection: bottleneck.connection.map(|[a, b]| FaceConnection::new(a, b)),
        });
        let moves = u32::try_from(self.moves).unwrap_or(u32::MAX);
        Ok(Plan { margin: self.margin, moves, bottleneck, actions })
    }
}

fn cells(start: &Configuration) -> Vec<Cell> {
    start.modules.iter().map(|module| module.placement.cell).collect()
}

/// The action with its turn, and the cells after it.
fn with_turn(cells: &mut [Cell], action: Action) -> PlannedAction {
    match action {
        Action::Attach(connection) => PlannedAction::Attach(connection.ports),
        Action::Detach(connection) => PlannedAction::Detach(connection.ports),
        Action::Slide { module, to } => {
            cells[module] = to;
            PlannedAction::Slide { module, to }
        }
        Action::Pivot { module, support, to } => {
            let (axis, quarter_turns) = turn(cells[module], cells[support], to).unwrap_or((Face::PosZ, 0));
            cells[module] = to;
            PlannedAction::Pivot { module, support, axis, quarter_turns, to }
        }
    }
}

/// The turn that takes a module from one cell to another about an edge that it
/// shares with its support; `None` when no turn does. It turns the side on which the
/// module leaves the support towards the direction it goes in, so the axis is the
/// cross product of the two.
fn turn(from: Cell, support: Cell, to: Cell) -> Option<(Face, u8)> {
    let side = Face::from_step(difference(from, support)?)?;
    let (direction, quarter_turns) = match Face::from_step(difference(to, from)?) {
        Some(direction) => (direction, 1),
        None => (Face::from_step(difference(to, support)?)?, 2),
    };
    let ([a, b, c], [x, y, z]) = (side.step(), direction.step());
    Some((Face::from_step([b * z - c * y, c * x - a * z, a * y - b * x])?, quarter_turns))
}

fn difference(a: Cell, b: Cell) -> Option<Cell> {
    Some([a[0].checked_sub(b[0])?, a[1].checked_sub(b[1])?, a[2].checked_sub(b[2])?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Rotation3, Unit, Vector3};

    /// The turn about the shared edge, done with matrices, must end in the cell.
    #[test]
    fn turns_lead_where_they_say() {
        let centre = |cell: Cell| Point3::from(Vector3::from(cell.map(|c| f64::from(c) + 0.5)));
        let mut seen = 0;
        for side in Face::ALL {
            for direction in Face::ALL {
                for straight in [true, false] {
                    let support = [3, -2, 5];
                    let add = |cell: Cell, face: Face| std::array::from_fn(|i| cell[i] + face.step()[i]);
                    let from: Cell = add(support, side);
                    let to: Cell = if straight { add(from, direction) } else { add(support, direction) };
                    let Some((axis, quarter_turns)) = turn(from, support, to) else {
                        assert!(side.axis() == direction.axis());
                        continue;
                    };
                    let (s, d) = (side.normal(), direction.normal());
                    let edge = centre(support) + (s + d) / 2.0;
                    let angle = f64::from(quarter_turns) * std::f64::consts::FRAC_PI_2;
                    let rotation = Rotation3::from_axis_angle(&Unit::new_normalize(axis.normal()), angle);
                    let arrived = edge + rotation * (centre(from) - edge);
                    assert!((arrived - centre(to)).norm() < 1e-12, "{side:?} {direction:?} {straight}");
                    seen += 1;
                }
            }
        }
        assert_eq!(seen, 48);
    }
}
