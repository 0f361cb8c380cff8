//! The reflection in a plane, and how columns behave in it.

use crate::spatial::Vec3;

/// Largest share of a column or load across the plane, or the other way round.
pub(super) const SAME: f64 = 1e-9;

/// Rows of a body's balance, or of its motion, in space.
pub(super) type Six = [f64; 6];

/// Columns of a group at one end of its link, with the body there.
pub(super) type End = Option<(usize, [Six; 6])>;

/// Both ends of it.
pub(super) type Ends = [End; 2];

/// How a vector behaves in the reflection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parity {
    Even,
    Odd,
    Neither,
}

/// A reflection that leaves `e_1` and `e_2` as they are and turns n around.
pub(super) struct Mirror {
    /// In the plane `(e_1, e_2)`, with n across.
    pub axes: [Vec3; 3],
}

impl Mirror {
    pub(super) fn new(normal: Vec3) -> Self {
        let helper = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
        let one = normal.cross(&helper).normalize();
        Self { axes: [one, normal.cross(&one), normal] }
    }

    /// Forces in the plane and the torque across it, which a mirror image shares.
    pub(super) fn even(&self, rows: &Six) -> [f64; 3] {
        let (force, torque) = halves(rows);
        let [one, two, across] = &self.axes;
        [force.dot(one), force.dot(two), torque.dot(across)]
    }

    /// The force across the plane and torques in it, which a mirror image has reversed.
    pub(super) fn odd(&self, rows: &Six) -> [f64; 3] {
        let (force, torque) = halves(rows);
        let [one, two, across] = &self.axes;
        [torque.dot(one), torque.dot(two), force.dot(across)]
    }

    pub(super) fn parity(&self, column: &[Six]) -> Parity {
        let (even, odd) = column.iter().fold((0.0_f64, 0.0_f64), |(even, odd), rows| {
            (even.max(size(&self.even(rows))), odd.max(size(&self.odd(rows))))
        });
        if odd <= SAME * even {
            Parity::Even
        } else if even <= SAME * odd {
            Parity::Odd
        } else {
            Parity::Neither
        }
    }
}

fn halves(rows: &Six) -> (Vec3, Vec3) {
    (Vec3::new(rows[0], rows[1], rows[2]), Vec3::new(rows[3], rows[4], rows[5]))
}

pub(super) fn size(v: &[f64; 3]) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// The columns `k` at both ends.
pub(super) fn columns(ends: &Ends, k: usize) -> Vec<Six> {
    ends.iter().flatten().map(|(_, columns)| columns[k]).collect()
}

/// Combines columns at both ends: for each kept column, factors of the group's.
pub(super) fn combine(ends: &Ends, kept: &[Vec<(usize, f64)>]) -> Ends {
    ends.each_ref().map(|end| {
        let (body, columns) = end.as_ref()?;
        let mut combined = [[0.0; 6]; 6];
        for (target, factors) in combined.iter_mut().zip(kept) {
            for &(k, factor) in factors {
                for (sum, entry) in target.iter_mut().zip(&columns[k]) {
                    *sum += factor * entry;
                }
            }
        }
        Some((*body, combined))
    })
}
