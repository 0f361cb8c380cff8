//! Hands a block's program to Clarabel.
//!
//! Clarabel gets the dual: its variables are the scaled twists v, its slacks
//! `s = c + A'v` the opening velocities, which must lie in the cones, and its
//! multipliers the scaled wrenches z. That is half the size of the primal form.
//! Nothing that comes back is believed: see `bracket`.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, SupportedConeT};

use super::groups::{Cone, Group};
use super::program::Program;
use super::respect::respect_unlimited;

/// One way of asking the solver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attempt {
    /// Tolerance on feasibility and gap of the scaled program.
    pub tolerance: f64,
    /// How far inside their cones the opening velocities are asked to be, added
    /// up over all cones. Positive, it keeps the twists admissible in spite of the
    /// solver's residuals, and rewards forces; negative, it charges for forces,
    /// which keeps them bounded, and lets the twists leave their cones a little.
    /// Either way it costs about this much of the scaled optimum.
    pub inset: f64,
    /// Static regularisation of the factorisation.
    pub regularization: f64,
}

/// Scaled strength up to which a cone gets its full inset.
const ORDINARY: f64 = 3.0;

/// Inset of one cone: a cone whose strength is many times the loads gets less, since its
/// strength times its inset is what that costs of the optimum.
pub(super) fn inset_of(group: &Group, inset: f64) -> f64 {
    inset / (group.rest / ORDINARY).max(1.0)
}

/// What the solver returned, scaled; possibly wrong, possibly a ray.
pub(super) struct Iterate {
    /// Twists, by row of the program.
    pub v: Vec<f64>,
    /// Variables, by column of the program.
    pub z: Vec<f64>,
    /// t over its scale.
    pub t: f64,
}

impl Iterate {
    /// The iterate of `from` in the units of `to`, which has the same variables.
    pub(super) fn measured(mut self, from: &Program, to: &Program) -> Self {
        if std::ptr::eq(from, to) {
            return self;
        }
        for (one, other) in from.groups.iter().zip(&to.groups) {
            for z in &mut self.z[one.first..one.first + one.len] {
                *z *= one.scale / other.scale;
            }
        }
        // Twists are of unit power where the scaled t is 1.
        let t = from.t_scale / to.t_scale;
        for ((v, one), other) in self.v.iter_mut().zip(&from.row_factor).zip(&to.row_factor) {
            *v *= one / other * t;
        }
        self.t *= t;
        self
    }
}

/// Iterations after which the solver gives up; it needs 8 to 25.
const ITERATIONS: u32 = 60;

/// Solves `program`. `None` when the solver could not even start or returned
/// something that is not finite. Where a structure can clamp itself, rewarding
/// forces lets them grow without end: such a field still proves a bound.
pub(super) fn solve(program: &Program, attempt: &Attempt) -> Option<Iterate> {
    let layout = Layout::new(program);
    let heads = program.groups.iter().filter(|group| group.cone != Cone::Free).count() as f64;
    let inset = attempt.inset / heads;
    let matrix = layout.matrix(program);
    let mut limits = vec![0.0; layout.height];
    for (group, &row) in program.groups.iter().zip(&layout.first_row) {
        if group.cone != Cone::Free {
            limits[row] = -inset_of(group, inset);
        }
    }
    limits[layout.preload_row] = 1.0;
    let objective: Vec<f64> = program.load.iter().map(|load| -load).collect();
    let nothing = CscMatrix::zeros((program.rows(), program.rows()));
    let settings = settings(attempt)?;
    let mut solver = DefaultSolver::new(&nothing, &objective, &matrix, &limits, &layout.cones, settings).ok()?;
    solver.solve();
    let (x, z) = (&solver.solution.x, &solver.solution.z);
    if !x.iter().chain(z).all(|value| value.is_finite()) {
        return None;
    }
    let mut variables = vec![0.0; program.variables];
    for (group, &row) in program.groups.iter().zip(&layout.first_row) {
        variables[group.first..group.first + group.len].copy_from_slice(&z[row..row + group.len]);
    }
    let mut v = x.clone();
    respect_unlimited(program, &mut v);
    Some(Iterate { v, z: variables, t: z[layout.preload_row] })
}

/// Clarabel's settings for `attempt`, whose inset they do not concern.
pub(super) fn settings(attempt: &Attempt) -> Option<DefaultSettings<f64>> {
    DefaultSettingsBuilder::default()
        .verbose(false)
        .presolve_enable(false)
        .direct_solve_method("qdldl".to_owned())
        .max_threads(1)
        .max_iter(ITERATIONS)
        .tol_feas(attempt.tolerance)
        .tol_gap_abs(attempt.tolerance)
        .tol_gap_rel(attempt.tolerance)
        .static_regularization_constant(attempt.regularization)
        .build()
        .ok()
}

/// Which of Clarabel's rows each group occupies: free ones first, then the
/// nonnegative ones with t, then the Lorentz cones.
struct Layout {
    first_row: Vec<usize>,
    preload_row: usize,
    height: usize,
    cones: Vec<SupportedConeT<f64>>,
}

impl Layout {
    fn new(program: &Program) -> Self {
        let mut first_row = vec![0; program.groups.len()];
        let mut height = 0;
        let mut place = |wanted: Cone, height: &mut usize| {
            for (index, group) in program.groups.iter().enumerate() {
                if group.cone == wanted {
                    first_row[index] = *height;
                    *height += group.len;
                }
            }
        };
        place(Cone::Free, &mut height);
        let free = height;
        place(Cone::NonNegative, &mut height);
        let preload_row = height;
        height += 1;
        let nonnegative = height - free;
        place(Cone::Lorentz, &mut height);
        let mut cones = vec![SupportedConeT::ZeroConeT(free), SupportedConeT::NonnegativeConeT(nonnegative)];
        if free == 0 {
            cones.remove(0);
        }
        let lorentz = program.groups.iter().filter(|group| group.cone == Cone::Lorentz);
        cones.extend(lorentz.map(|group| SupportedConeT::SecondOrderConeT(group.len)));
        Self { first_row, preload_row, height, cones }
    }

    /// `-A'` with t's column, in compressed columns: one per balance row.
    fn matrix(&self, program: &Program) -> CscMatrix<f64> {
        let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); program.rows()];
        for (group, &first) in program.groups.iter().zip(&self.first_row) {
            for k in 0..group.len {
                for (row, value) in program.entries(group, k) {
                    columns[row].push((first + k, -value));
                }
            }
        }
        for (column, value) in columns.iter_mut().zip(&program.preload).filter(|(_, value)| **value != 0.0) {
            column.push((self.preload_row, -value));
        }
        let mut starts = Vec::with_capacity(columns.len() + 1);
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        starts.push(0);
        for column in &mut columns {
            column.sort_unstable_by_key(|entry| entry.0);
            rows.extend(column.iter().map(|entry| entry.0));
            values.extend(column.iter().map(|entry| entry.1));
            starts.push(rows.len());
        }
        CscMatrix::new(self.height, program.rows(), starts, rows, values)
    }
}
