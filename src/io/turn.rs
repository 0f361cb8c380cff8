//! About which axis, and how far, a module turns about an edge. The planner counts
//! in cells; files say this too, for those who drive motors.

use std::fmt;

use crate::reconfigure::{Action, Turn};
use crate::robot::{Cell, Configuration, Face};

/// A turn about a world direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AxisAngle {
    /// World direction that the turn is right-handed about.
    pub axis: Face,
    /// How far.
    pub turn: Turn,
}

impl AxisAngle {
    /// The turn that takes a module from one cell to another about an edge that it
    /// shares with its support; `None` when no turn does.
    ///
    /// It turns the side on which the module leaves the support towards the direction it goes
    /// in, so the axis is the cross product of the two.
    pub fn between(from: Cell, support: Cell, to: Cell) -> Option<Self> {
        let side = Face::from_step(difference(from, support)?)?;
        let (direction, turn) = match Face::from_step(difference(to, from)?) {
            Some(direction) => (direction, Turn::Quarter),
            None => (Face::from_step(difference(to, support)?)?, Turn::Half),
        };
        let ([a, b, c], [x, y, z]) = (side.step(), direction.step());
        let axis = Face::from_step([b * z - c * y, c * x - a * z, a * y - b * x])?;
        Some(Self { axis, turn })
    }
}

impl fmt::Display for AxisAngle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} degrees about {}", self.turn.degrees(), self.axis.name())
    }
}

/// Where the modules are in the course of a plan.
#[derive(Clone, Debug)]
pub(super) struct Cells(Vec<Cell>);

impl Cells {
    /// Those of a configuration.
    pub(super) fn of(configuration: &Configuration) -> Self {
        Self(configuration.modules.iter().map(|module| module.placement.cell).collect())
    }

    /// Carries out an action, however odd, and says which turn it makes; `None` for
    /// all but turns, and for one that no turn makes.
    pub(super) fn take(&mut self, action: &Action) -> Option<AxisAngle> {
        let at = |module: usize| self.0.get(module).copied();
        let (module, to, turn) = match *action {
            Action::Attach(_) | Action::Detach(_) => return None,
            Action::Move { module, support, to, .. } => {
                let cells = at(module).zip(support.and_then(at));
                (module, to, cells.and_then(|(from, support)| AxisAngle::between(from, support, to)))
            }
        };
        if let Some(cell) = self.0.get_mut(module) {
            *cell = to;
        }
        turn
    }
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
                    let Some(AxisAngle { axis, turn }) = AxisAngle::between(from, support, to) else {
                        assert!(side.axis() == direction.axis());
                        continue;
                    };
                    let (s, d) = (side.normal(), direction.normal());
                    let edge = centre(support) + (s + d) / 2.0;
                    let angle = turn.degrees().to_radians();
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
