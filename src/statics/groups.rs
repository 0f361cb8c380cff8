//! Groups of a program's variables: what each stands for, and the cone it lies in.
//!
//! Knows one link's components, nothing of bodies or of the program as a whole.

use super::maps::Six;

/// The cone that a group of consecutive variables lies in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cone {
    /// No restriction.
    Free,
    /// Each variable is at least zero.
    NonNegative,
    /// A Lorentz cone, its head first.
    Lorentz,
}

/// What a group's variables stand for in its link's frame, per newton.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// Variable `k` acts along a component, times a factor.
    Axes([(usize, f64); 6]),
    /// The force `(f_z, f_x / mu, f_y / mu)` of a point in the plane z = 0; without
    /// friction only `f_z`.
    Point { at: [f64; 2], friction: f64 },
    /// Nothing: a slack.
    Slack,
}

/// A group of consecutive variables in one cone, all of one link.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub cone: Cone,
    /// First variable and number of variables.
    pub first: usize,
    pub len: usize,
    /// Index of the link in the block.
    pub link: usize,
    pub form: Form,
    /// Force in N that a scaled variable of 1 stands for.
    pub scale: f64,
    /// The first variable where the link carries nothing at the typical utilisation:
    /// its strength, scaled.
    pub rest: f64,
    /// The row that ties this variable to another slack of the same component.
    pub tie_row: Option<usize>,
    /// For a slack that only ties a box component: the variable it belongs to.
    pub ties: Option<usize>,
}

impl Group {
    /// The group's part of a vector over all variables.
    pub(super) fn part<'v>(&self, x: &'v [f64]) -> &'v [f64] {
        &x[self.first..self.first + self.len]
    }

    /// Adds the wrench of the scaled variables `x` of this group.
    pub(super) fn add_wrench(&self, x: &[f64], wrench: &mut Six) {
        match &self.form {
            Form::Axes(axes) => {
                for (value, (axis, factor)) in x.iter().zip(axes) {
                    wrench[*axis] += self.scale * factor * value;
                }
            }
            Form::Point { at: [px, py], friction } => {
                let normal = self.scale * x[0];
                wrench[2] += normal;
                wrench[3] += py * normal;
                wrench[4] -= px * normal;
                if let [_, x, y] = *x {
                    let (fx, fy) = (self.scale * friction * x, self.scale * friction * y);
                    wrench[0] += fx;
                    wrench[1] += fy;
                    wrench[5] += px * fy - py * fx;
                }
            }
            Form::Slack => {}
        }
    }
}
