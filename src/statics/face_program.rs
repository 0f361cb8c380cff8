//! The least total normal force at a face's points, as a cone program in five rows.
//!
//! A dense primal-dual interior-point method (Nesterov-Todd direction, Mehrotra's
//! predictor and corrector), whose answer is a bracket from its two sides.
//!
//! Knows points and rows, nothing of wrenches or connectors.

use nalgebra::{Cholesky, Matrix2, SMatrix, SVector, Vector2};

use super::assessment::Bracket;
use super::second_order::{Scaling, divide, dot, product, slack, step_length};

/// Iterations after which the method gives up; it needs 8 to 15.
const ITERATIONS: usize = 60;

/// Complementarity, relative to the value, at which it stops.
const GAP: f64 = 1e-14;

/// Relative size from which a direction of forces counts as one that points of a
/// degenerate patch do not have, and a wrench as having a part in it.
pub(super) const UNHELD: f64 = 1e-11;

/// Shear along x and y, bending about x and y, and torsion.
pub(super) type Rows = SVector<f64, 5>;

/// A face's points, of unit size, that are to carry shear, bending and torsion.
pub(super) struct FaceProgram<'p> {
    points: &'p [[f64; 2]],
    /// Shear and torsion over the friction coefficient: then there is but one cone.
    pub wanted: Rows,
    /// Positive normal forces whose centre of pressure is the origin.
    pub pressure: Vec<f64>,
    /// Projection onto the directions that no force of the points has: none for
    /// points around the origin, some for a single point or points in a row.
    pub unheld: SMatrix<f64, 5, 5>,
    /// Factor of `A A'`, made regular in the directions of `unheld`.
    pub gram: Option<Cholesky<f64, nalgebra::Const<5>>>,
}

/// What the iteration came to.
pub(super) struct Solved {
    /// The motion that proves the lower bound, by row.
    pub y: Rows,
    pub total: Bracket,
    /// The points' forces that the upper bound came from, before they were repaired.
    pub x: Vec<[f64; 3]>,
}

impl<'p> FaceProgram<'p> {
    pub(super) fn new(points: &'p [[f64; 2]], wanted: Rows) -> Self {
        let mut program =
            Self { points, wanted, pressure: central_pressure(points), unheld: SMatrix::zeros(), gram: None };
        let identity: Vec<Scaling<3>> =
            points.iter().map(|_| Scaling::new(&[1.0, 0.0, 0.0], &[1.0, 0.0, 0.0])).collect();
        let directions = program.normal_matrix(&identity).symmetric_eigen();
        let smallest = UNHELD * directions.eigenvalues.amax();
        for (value, direction) in directions.eigenvalues.iter().zip(directions.eigenvectors.column_iter()) {
            if *value <= smallest {
                program.unheld += direction * direction.transpose();
            }
        }
        program.gram = program.normal_matrix(&identity).cholesky();
        program
    }

    /// `A_j z` for one point: what its force `(g_z, g_x / mu, g_y / mu)` adds to the rows, those of
    /// shear and torsion over mu.
    fn rows(&self, point: usize, z: &[f64; 3]) -> Rows {
        let [px, py] = self.points[point];
        let [_, gx, gy] = *z;
        Rows::new(gx, gy, py * z[0], -px * z[0], px * gy - py * gx)
    }

    /// `A_j' y`.
    pub(super) fn columns(&self, point: usize, y: &Rows) -> [f64; 3] {
        let [px, py] = self.points[point];
        [py * y[2] - px * y[3], y[0] - py * y[4], y[1] + px * y[4]]
    }

    /// Iterates until the bracket is tight, or no further.
    pub(super) fn solve(&self) -> Solved {
        let count = self.points.len();
        let degree = count as f64;
        let head = [1.0, 0.0, 0.0];
        let mut x = vec![head; count];
        let mut s = vec![head; count];
        let mut y = Rows::zeros();
        let mut best = Solved { y, total: Bracket::new(0.0, f64::INFINITY), x: x.clone() };
        for _ in 0..ITERATIONS {
            let missing = self.missing(&x);
            let dual_missing: Vec<[f64; 3]> = (0..count)
                .map(|j| {
                    let column = self.columns(j, &y);
                    std::array::from_fn(|k| head[k] - column[k] - s[j][k])
                })
                .collect();
            self.keep_bounds(&x, &y, &missing, &mut best);
            let mu = x.iter().zip(&s).map(|(x, s)| dot(x, s)).sum::<f64>() / degree;
            let tight = best.total.upper.is_finite() && best.total.width() <= GAP * best.total.upper;
            if tight || mu <= GAP * GAP {
                break;
            }
            let scalings: Vec<Scaling<3>> = x.iter().zip(&s).map(|(x, s)| Scaling::new(x, s)).collect();
            let points: Vec<[f64; 3]> = scalings.iter().zip(&x).map(|(w, x)| w.apply(x)).collect();
            let Some(factor) = self.normal_matrix(&scalings).cholesky() else { break };
            let newton = |target: &[[f64; 3]]| {
                let mut rhs = missing;
                for j in 0..count {
                    let scaled = scalings[j].apply_inverse(&dual_missing[j]);
                    let change: [f64; 3] = std::array::from_fn(|k| scaled[k] - target[j][k]);
                    rhs += self.rows(j, &scalings[j].apply_inverse(&change));
                }
                let dy = factor.solve(&rhs);
                let steps: Vec<([f64; 3], [f64; 3])> = (0..count)
                    .map(|j| {
                        let column = self.columns(j, &dy);
                        let ds: [f64; 3] = std::array::from_fn(|k| dual_missing[j][k] - column[k]);
                        let scaled = scalings[j].apply_inverse(&ds);
                        let dx = scalings[j].apply_inverse(&std::array::from_fn(|k| target[j][k] - scaled[k]));
                        (dx, ds)
                    })
                    .collect();
                (dy, steps)
            };
            let affine: Vec<[f64; 3]> = points.iter().map(|p| p.map(|v| -v)).collect();
            let (_, predictor) = newton(&affine);
            let reach = step(&x, &s, &predictor, 1.0);
            let sigma = (1.0 - reach).powi(3);
            let target: Vec<[f64; 3]> = (0..count)
                .map(|j| {
                    let (dx, ds) = &predictor[j];
                    let second = product(&scalings[j].apply(dx), &scalings[j].apply_inverse(ds));
                    let square = product(&points[j], &points[j]);
                    let rhs = std::array::from_fn(|k| sigma * mu * head[k] - square[k] - second[k]);
                    divide(&points[j], &rhs)
                })
                .collect();
            let (dy, steps) = newton(&target);
            let length = step(&x, &s, &steps, 0.99);
            if !(length > 1e-10) {
                break;
            }
            y += dy * length;
            for j in 0..count {
                for k in 0..3 {
                    x[j][k] += length * steps[j].0[k];
                    s[j][k] += length * steps[j].1[k];
                }
            }
        }
        best
    }

    pub(super) fn missing(&self, x: &[[f64; 3]]) -> Rows {
        x.iter().enumerate().fold(self.wanted, |rows, (j, z)| rows - self.rows(j, z))
    }

    fn normal_matrix(&self, scalings: &[Scaling<3>]) -> SMatrix<f64, 5, 5> {
        let mut matrix = SMatrix::<f64, 5, 5>::zeros();
        for (j, scaling) in scalings.iter().enumerate() {
            for row in 0..5 {
                let column = self.columns(j, &Rows::ith(row, 1.0));
                let square = scaling.apply_inverse(&scaling.apply_inverse(&column));
                matrix.set_column(row, &(matrix.column(row) + self.rows(j, &square)));
            }
        }
        (matrix + matrix.transpose()) * 0.5 + self.unheld
    }

    /// Tightens the bracket with what the iterate proves: `y`, shrunk until it
    /// is admissible, from below; `x`, once it is balanced, from above.
    fn keep_bounds(&self, x: &[[f64; 3]], y: &Rows, missing: &Rows, best: &mut Solved) {
        let outside = (0..self.points.len())
            .map(|j| {
                let column = self.columns(j, y);
                -slack(&[1.0 - column[0], -column[1], -column[2]])
            })
            .fold(0.0, f64::max);
        let admissible = y / (1.0 + outside * (1.0 + 1e-15));
        let lower = self.wanted.dot(&admissible);
        if lower > best.total.lower {
            best.total.lower = lower;
            best.y = admissible;
        }
        let upper = self.repaired(x, missing);
        if upper < best.total.upper {
            best.total.upper = upper.max(best.total.lower);
            best.x.copy_from_slice(x);
        }
    }

    /// Total normal force of `x` after its imbalance has been taken up by the
    /// smallest change of the points' forces, and the cones have been restored by
    /// pressing harder everywhere at once without shifting the centre of pressure.
    fn repaired(&self, x: &[[f64; 3]], missing: &Rows) -> f64 {
        let Some(multipliers) = self.gram.as_ref().map(|gram| gram.solve(missing)) else { return f64::INFINITY };
        let (mut total, mut pressing) = (0.0, 0.0_f64);
        for (j, z) in x.iter().enumerate() {
            let change = self.columns(j, &multipliers);
            let moved: [f64; 3] = std::array::from_fn(|k| z[k] + change[k]);
            total += moved[0];
            pressing = pressing.max(-slack(&moved) / self.pressure[j]);
        }
        total + pressing * self.pressure.iter().sum::<f64>()
    }
}

/// Positive weights `b_j` with `sum b_j p_j = 0`: those of the analytic centre,
/// `b_j = 1 / (1 + q.p_j)`. With the origin on the hull's boundary some weights
/// stay near zero, and bounds that lean on them are loose.
fn central_pressure(points: &[[f64; 2]]) -> Vec<f64> {
    let mut q = Vector2::zeros();
    let weight = |q: &Vector2<f64>, p: &[f64; 2]| 1.0 / (1.0 + q.x * p[0] + q.y * p[1]);
    for _ in 0..50 {
        let (mut gradient, mut hessian) = (Vector2::zeros(), Matrix2::zeros());
        for p in points {
            let (b, p) = (weight(&q, p), Vector2::new(p[0], p[1]));
            gradient += p * b;
            hessian += p * p.transpose() * (b * b);
        }
        let Some(step) = hessian.cholesky().map(|factor| factor.solve(&gradient)) else { break };
        let decrement = gradient.dot(&step).sqrt();
        q += step / (1.0 + if decrement > 0.25 { decrement } else { 0.0 });
        if !(decrement > 1e-15) {
            break;
        }
    }
    points.iter().map(|p| weight(&q, p).max(f64::MIN_POSITIVE)).collect()
}

fn step(x: &[[f64; 3]], s: &[[f64; 3]], steps: &[([f64; 3], [f64; 3])], shorten: f64) -> f64 {
    let mut length: f64 = 1.0;
    for ((x, s), (dx, ds)) in x.iter().zip(s).zip(steps) {
        length = length.min(step_length(x, dx, shorten)).min(step_length(s, ds, shorten));
    }
    length
}
