//! How a link's wrench acts on the balances of the bodies it joins.

use nalgebra::{Matrix6, Vector6};

use crate::spatial::Vec3;

use super::frame::LinkFrame;

/// Six components of a wrench or twist at a link, in its frame: forces (velocities)
/// before torques (rates).
pub(super) type Six = [f64; 6];

/// One end of a link: the wrench in the link's frame, in N and N m, to the scaled
/// balance rows of the body there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Index of the body in the block.
    pub body: usize,
    /// Sign of the link's wrench on this body.
    pub sign: f64,
    /// Six rows by six components.
    pub map: Matrix6<f64>,
}

impl Side {
    /// For a body at `com` whose force and torque balances are scaled by `factor`.
    pub(super) fn new(frame: &LinkFrame, body: usize, sign: f64, com: &Vec3, factor: [f64; 2]) -> Self {
        let [force, torque] = factor.map(|factor| sign * factor);
        let arm = frame.origin - com;
        let mut map = Matrix6::zeros();
        for (k, axis) in frame.axes.column_iter().enumerate() {
            let lever = arm.cross(&axis);
            for r in 0..3 {
                map[(r, k)] = axis[r] * force;
                map[(r + 3, k)] = lever[r] * torque;
                map[(r + 3, k + 3)] = axis[r] * torque;
            }
        }
        Self { body, sign, map }
    }

    /// `rows += map wrench`.
    pub(super) fn push(&self, wrench: &Six, rows: &mut [f64]) {
        let rows = &mut rows[6 * self.body..6 * self.body + 6];
        for (column, value) in self.map.data.0.iter().zip(wrench) {
            for (row, entry) in rows.iter_mut().zip(column) {
                *row += entry * value;
            }
        }
    }

    /// `map' rows`: what the body's scaled twist adds to the link's relative twist.
    pub(super) fn pull(&self, rows: &[f64]) -> Vector6<f64> {
        self.map.tr_mul(&Vector6::from_column_slice(&rows[6 * self.body..6 * self.body + 6]))
    }
}

/// The bodies at a link's plus and minus side, by their index in the block; `None` where it is held.
pub(super) type Ends = [Option<usize>; 2];

/// The ends of a link that need balance: the plus side, then the minus side.
pub(super) type Sides = [Option<Side>; 2];

/// The relative twist at a link, in its frame, of scaled twists.
pub(super) fn relative(sides: &Sides, rows: &[f64]) -> Six {
    let sum = sides.iter().flatten().map(|side| side.pull(rows)).sum::<Vector6<f64>>();
    sum.into()
}
