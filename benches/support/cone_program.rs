//! Cone programs in standard form, handed to Clarabel: for methods that are
//! compared with the oracle. Knows no structures. Generic in the number type, so
//! that the same program can be solved with twice the digits.

use clarabel::algebra::{CscMatrix, FloatT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// What a group of variables is restricted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cone {
    /// Nothing.
    Free,
    /// Each at least zero.
    NonNegative,
    /// The first at least the length of the others.
    Lorentz,
}

/// One variable: its cost and its coefficients by row.
#[derive(Clone, Debug)]
pub struct Column<T> {
    pub cost: T,
    pub entries: Vec<(usize, T)>,
}

/// `min c'x  subject to  A x = b, x in K`, column by column; the groups follow one
/// another in the order of the columns.
#[derive(Clone, Debug, Default)]
pub struct ConeProgram<T> {
    pub rhs: Vec<T>,
    pub columns: Vec<Column<T>>,
    pub groups: Vec<(Cone, usize)>,
}

/// What the solver says. Neither value is proved.
#[derive(Clone, Debug)]
pub struct Solution<T> {
    pub status: SolverStatus,
    /// The value of the variables found.
    pub value: T,
    /// The value of the multipliers found.
    pub dual_value: T,
    /// The larger relative residual of the two.
    pub residual: T,
}

impl<T: FloatT> ConeProgram<T> {
    /// Adds a group of variables; returns the first one's index.
    pub fn group(&mut self, cone: Cone, columns: impl IntoIterator<Item = Column<T>>) -> usize {
        let first = self.columns.len();
        self.columns.extend(columns);
        self.groups.push((cone, self.columns.len() - first));
        first
    }

    /// Adds `count` rows with right-hand side zero; returns the first one's index.
    pub fn rows(&mut self, count: usize) -> usize {
        self.rhs.resize(self.rhs.len() + count, T::zero());
        self.rhs.len() - count
    }

    /// Solves the dual `max b'y  subject to  c - A'y in K*`, which is the smaller of the two
    /// ways to state it: a variable per row, a slack per column. `None` when the
    /// solver refuses to start.
    pub fn solve(&self, settings: DefaultSettings<T>) -> Option<Solution<T>> {
        let (order, cones) = self.layout();
        let mut rows: Vec<Vec<(usize, T)>> = vec![Vec::new(); self.rhs.len()];
        for (place, &column) in order.iter().enumerate() {
            for &(row, value) in &self.columns[column].entries {
                // Several parts of one variable in one row add up.
                match rows[row].last_mut() {
                    Some(last) if last.0 == place => last.1 += value,
                    _ => rows[row].push((place, value)),
                }
            }
        }
        let mut starts = vec![0];
        let (mut indices, mut values) = (Vec::new(), Vec::new());
        for row in rows {
            for (place, value) in row {
                indices.push(place);
                values.push(value);
            }
            starts.push(indices.len());
        }
        let matrix = CscMatrix::new(order.len(), self.rhs.len(), starts, indices, values);
        let limits: Vec<T> = order.iter().map(|&column| self.columns[column].cost).collect();
        let objective: Vec<T> = self.rhs.iter().map(|&b| -b).collect();
        let nothing = CscMatrix::zeros((self.rhs.len(), self.rhs.len()));
        let mut solver = DefaultSolver::new(&nothing, &objective, &matrix, &limits, &cones, settings).ok()?;
        solver.solve();
        let found = &solver.solution;
        Some(Solution {
            status: found.status,
            value: -found.obj_val_dual,
            dual_value: -found.obj_val,
            residual: found.r_prim.max(found.r_dual),
        })
    }

    /// The columns sorted by cone, and Clarabel's cones for them.
    fn layout(&self) -> (Vec<usize>, Vec<SupportedConeT<T>>) {
        let mut order = Vec::with_capacity(self.columns.len());
        let mut cones = Vec::new();
        for wanted in [Cone::Free, Cone::NonNegative, Cone::Lorentz] {
            let (mut first, before) = (0, order.len());
            for &(cone, len) in &self.groups {
                if cone == wanted {
                    order.extend(first..first + len);
                    if cone == Cone::Lorentz {
                        cones.push(SupportedConeT::SecondOrderConeT(len));
                    }
                }
                first += len;
            }
            match (wanted, order.len() - before) {
                (_, 0) | (Cone::Lorentz, _) => {}
                // The dual of no restriction is to vanish.
                (Cone::Free, len) => cones.push(SupportedConeT::ZeroConeT(len)),
                (Cone::NonNegative, len) => cones.push(SupportedConeT::NonnegativeConeT(len)),
            }
        }
        (order, cones)
    }
}

/// Clarabel's own settings, one thread, with all three tolerances at `tolerance`.
pub fn settings(tolerance: f64) -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        direct_solve_method: "qdldl".to_owned(),
        max_threads: 1,
        tol_feas: tolerance,
        tol_gap_abs: tolerance,
        tol_gap_rel: tolerance,
        ..DefaultSettings::default()
    }
}
