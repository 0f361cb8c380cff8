//! A cone program with every Lorentz cone replaced by a pyramid, so that it
//! becomes a linear one.
//!
//! A circular cone becomes one over a regular polygon, spanned by its edges. A
//! cone over more than two directions is nested from such ones by new variables:
//! `|(u, v, w)| <= h` is `|(u, v)| <= a` and `|(a, w)| <= h` (Ben-Tal and Nemirovski
//! 2001, section 2, without their shorter description of one polygon). Inscribed
//! polygons restrict the wrenches, so that the optimum is an upper bound on the utilisation;
//! circumscribed ones give a lower bound.

use std::f64::consts::{PI, TAU};

use crate::cone_program::{Column, Cone, ConeProgram};

/// Where the polygons lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Inscribed: an upper bound on the utilisation.
    Inner,
    /// Circumscribed: a lower bound.
    Outer,
}

/// A coordinate of a nested cone.
#[derive(Clone, Copy)]
enum Coordinate {
    /// A variable of the original program.
    Variable(usize),
    /// The length of two others: known by the row that ties it, never negative.
    Length(usize),
}

/// `program` over pyramids with `sides` sides, a multiple of four.
pub fn linear(program: &ConeProgram<f64>, side: Side, sides: usize) -> ConeProgram<f64> {
    let mut result = ConeProgram { rhs: program.rhs.clone(), columns: Vec::new(), groups: Vec::new() };
    let mut first = 0;
    for &(cone, len) in &program.groups {
        if cone == Cone::Lorentz {
            let head = Coordinate::Variable(first);
            let mut open: Vec<Coordinate> = (first + 1..first + len).map(Coordinate::Variable).collect();
            while open.len() > 2 {
                let tie = Coordinate::Length(result.rows(1));
                let pair = [open.remove(0), open.remove(0)];
                polygon(program, &mut result, (side, sides), tie, pair);
                open.push(tie);
            }
            let pair = [open[0], open[1]];
            polygon(program, &mut result, (side, sides), head, pair);
        } else {
            result.group(cone, program.columns[first..first + len].iter().cloned());
        }
        first += len;
    }
    result
}

/// Adds the edges of the pyramid `|(u, v)| <= head` as variables.
fn polygon(
    program: &ConeProgram<f64>,
    result: &mut ConeProgram<f64>,
    (side, sides): (Side, usize),
    head: Coordinate,
    pair: [Coordinate; 2],
) {
    let radius = match side {
        Side::Inner => 1.0,
        Side::Outer => 1.0 / (PI / sides as f64).cos(),
    };
    let columns = (0..sides).filter_map(|k| {
        let angle = TAU * k as f64 / sides as f64;
        let at = [radius * angle.cos(), radius * angle.sin()];
        // A corner lies on every half axis, so those with a negative length are not needed.
        let needed = pair.iter().zip(at).all(|(part, at)| matches!(part, Coordinate::Variable(_)) || at > -1e-9);
        needed.then(|| {
            let mut column = Column { cost: 0.0, entries: Vec::new() };
            add(program, &mut column, head, 1.0, 1.0);
            for (part, at) in pair.into_iter().zip(at) {
                add(program, &mut column, part, at, -1.0);
            }
            column
        })
    });
    let columns: Vec<_> = columns.collect();
    result.group(Cone::NonNegative, columns);
}

/// Adds `share` of a coordinate to a column; `sign` is that of a length in its tie.
fn add(program: &ConeProgram<f64>, column: &mut Column<f64>, part: Coordinate, share: f64, sign: f64) {
    match part {
        Coordinate::Variable(index) => {
            let source = &program.columns[index];
            column.cost += share * source.cost;
            column.entries.extend(source.entries.iter().map(|&(row, value)| (row, share * value)));
        }
        Coordinate::Length(row) => column.entries.push((row, sign * share)),
    }
}
