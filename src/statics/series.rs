//! Springs in series, as triangles: `R'R = sum B'B` one spring after another, by
//! reflections, so that nothing is squared; and what such triangles are the inverse of.

use nalgebra::{SMatrix, SVector};

/// Least pivot of a chain's root, as a share of the largest.
const LEAST_PIVOT: f64 = 1e-14;

/// The reflections that bring `[R; B]`, R an upper triangle, to a triangle again.
pub(super) struct Stacked<const D: usize> {
    /// Per column: the reflection's vector in R's row, in B's rows, and its factor.
    head: [f64; D],
    tail: [SVector<f64, D>; D],
    factor: [f64; D],
}

impl<const D: usize> Stacked<D> {
    /// Stacks `rows` under `triangle`, which becomes that of both.
    pub(super) fn new(triangle: &mut SMatrix<f64, D, D>, mut rows: SMatrix<f64, D, D>) -> Self {
        let mut stacked = Self { head: [0.0; D], tail: [SVector::zeros(); D], factor: [0.0; D] };
        for k in 0..D {
            let (pivot, below) = (triangle[(k, k)], rows.column(k).into_owned());
            let length = pivot.hypot(below.norm());
            if length == 0.0 {
                continue;
            }
            // Away from the pivot's own sign nothing cancels.
            let turned = if pivot > 0.0 { -length } else { length };
            let head = pivot - turned;
            let factor = -(turned * head).recip();
            triangle[(k, k)] = turned;
            for c in k + 1..D {
                let along = (head * triangle[(k, c)] + below.dot(&rows.column(c))) * factor;
                triangle[(k, c)] -= along * head;
                rows.column_mut(c).axpy(-along, &below, 1.0);
            }
            (stacked.head[k], stacked.tail[k], stacked.factor[k]) = (head, below, factor);
        }
        stacked
    }

    /// The rows of the triangle in `Q' [top; bottom]`.
    pub(super) fn reduce(&self, mut top: SVector<f64, D>, mut bottom: SVector<f64, D>) -> SVector<f64, D> {
        for k in 0..D {
            let along = (self.head[k] * top[k] + self.tail[k].dot(&bottom)) * self.factor[k];
            top[k] -= along * self.head[k];
            bottom.axpy(-along, &self.tail[k], 1.0);
        }
        top
    }
}

/// The inverse of an upper triangle; where that is singular to rounding, of one
/// that is not.
pub(super) fn inverse<const D: usize>(triangle: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    let largest = triangle.diagonal().amax();
    let mut regular = *triangle;
    for k in 0..D {
        let pivot = regular[(k, k)];
        if !(pivot.abs() > LEAST_PIVOT * largest) {
            regular[(k, k)] = (LEAST_PIVOT * largest).max(f64::MIN_POSITIVE.sqrt()).copysign(pivot);
        }
    }
    regular.solve_upper_triangular(&SMatrix::identity()).unwrap_or_else(SMatrix::zeros)
}

/// The root G of the inverse of a link's stiffness, `K G G' = 1`, where nothing
/// better than K itself is known.
pub(super) fn flexibility_root<const D: usize>(stiffness: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    // Forces and torques differ in unit: scale the diagonal to 1 first.
    let unit = stiffness.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 1.0 });
    let mut factor =
        SMatrix::<f64, D, D>::from_fn(|r, c| if r >= c { stiffness[(r, c)] * unit[r] * unit[c] } else { 0.0 });
    for c in 0..D {
        let pivot = factor[(c, c)].max(LEAST_PIVOT).sqrt();
        factor[(c, c)] = pivot;
        for r in c + 1..D {
            factor[(r, c)] /= pivot;
        }
        for d in c + 1..D {
            for r in d..D {
                factor[(r, d)] -= factor[(r, c)] * factor[(d, c)];
            }
        }
    }
    SMatrix::<f64, D, D>::from_diagonal(&unit) * inverse::<D>(&factor.transpose())
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix6, Vector6};

    use super::*;

    fn matrix(seed: usize) -> Matrix6<f64> {
        Matrix6::from_fn(|r, c| ((seed * 7 + r * 13 + c * 5 + r * c) % 11) as f64 - 5.0)
    }

    #[test]
    fn squares_add_up_and_least_squares_are_solved() {
        let mut triangle = Matrix6::zeros();
        let (mut squares, mut mixed, mut reduced) = (Matrix6::zeros(), Vector6::zeros(), Vector6::zeros());
        for n in 0..5 {
            let (rows, wanted) = (matrix(n), matrix(n + 20).column(1).into_owned());
            squares += rows.tr_mul(&rows);
            mixed += rows.tr_mul(&wanted);
            reduced = Stacked::new(&mut triangle, rows).reduce(reduced, wanted);
        }
        assert!((triangle.tr_mul(&triangle) - squares).norm() < 1e-12 * squares.norm());
        assert!((triangle.tr_mul(&reduced) - mixed).norm() < 1e-12 * mixed.norm());
        assert_eq!(triangle, triangle.upper_triangle());
    }
}
