//! A block's program as columns: what each group of variables does to the balances.

use super::conic::inset_of;
use super::groups::{Cone, Form, Group};
use super::program::Program;
use super::tolerances::ROUNDING;

/// Scaled force at which a cone starts: about what the spanning tree carries.
pub(super) const START: f64 = 1.0;

/// Scaled strength from which on every cone starts where it rests: what it lacked
/// otherwise would be many times the loads.
const FAR: f64 = 1e3;

/// A group of variables in one cone, as it acts on the balances of its link's
/// bodies, D rows each.
#[derive(Clone, Debug)]
pub(super) struct Part<const D: usize> {
    pub cone: Cone,
    /// First variable and number of variables.
    pub first: usize,
    pub len: usize,
    pub link: usize,
    /// Per end of the link: the body, and a column per variable.
    pub ends: [Option<(usize, [[f64; D]; 6])>; 2],
    /// The component of the link's wrench along which each variable acts, and the
    /// wrench per variable; `None` for points.
    pub axes: Option<[(usize, f64); 6]>,
    /// The first variable where the link carries nothing, see [`Group`]; where a cone starts.
    pub rest: f64,
    pub start: f64,
    /// Share of an even inset that a cone gets.
    pub inset: f64,
    /// See [`Group`].
    pub tie_row: Option<usize>,
    pub ties: Option<usize>,
}

/// All groups of `program`, in its order.
pub(super) fn parts(program: &Program) -> Vec<Part<6>> {
    program.groups.iter().map(|group| part(program, group)).collect()
}

/// Takes away what rounding of directions leaves of a variable along the others. A body that
/// nothing holds along an axis would be held by it, next to not at all, and drift off.
fn clear_rounding(column: &mut [f64; 6]) {
    let largest = column.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    for entry in column.iter_mut().filter(|entry| entry.abs() <= ROUNDING * largest) {
        *entry = 0.0;
    }
}

fn part(program: &Program, group: &Group) -> Part<6> {
    let ends = program.sides[group.link].each_ref().map(|side| {
        let side = side.as_ref()?;
        let map = &side.map.data.0;
        let mut columns = [[0.0; 6]; 6];
        match &group.form {
            Form::Slack => return None,
            Form::Axes(axes) => {
                for (column, (axis, factor)) in columns[..group.len].iter_mut().zip(axes) {
                    *column = map[*axis].map(|entry| group.scale * factor * entry);
                }
            }
            Form::Point { at: [px, py], friction } => {
                let combined = |factor: f64, axis: usize, [(b, fb), (c, fc)]: [(usize, f64); 2]| {
                    std::array::from_fn(|r| factor * (map[axis][r] + fb * map[b][r] + fc * map[c][r]))
                };
                columns[0] = combined(group.scale, 2, [(3, *py), (4, -px)]);
                if group.len == 3 {
                    columns[1] = combined(group.scale * friction, 0, [(5, -py), (5, 0.0)]);
                    columns[2] = combined(group.scale * friction, 1, [(5, *px), (5, 0.0)]);
                }
            }
        }
        for column in &mut columns[..group.len] {
            clear_rounding(column);
        }
        Some((side.body, columns))
    });
    let axes = match &group.form {
        Form::Axes(axes) => Some(axes.map(|(axis, factor)| (axis, factor * group.scale))),
        Form::Point { .. } | Form::Slack => None,
    };
    let Group { cone, first, len, link, rest, tie_row, ties, .. } = *group;
    let start = if len == 6 || rest > FAR { rest.max(START) } else { START };
    Part { cone, first, len, link, ends, axes, rest, start, inset: inset_of(group, 1.0), tie_row, ties }
}
