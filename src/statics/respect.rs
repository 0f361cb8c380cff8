//! Makes a twist field respect what no strength limits.
//!
//! Along a component without limits on either side a connection lets nothing
//! move, whatever its strength. The solver meets these equations up to its
//! tolerance only; the smallest change of the scaled twists that meets them to
//! rounding is found here by one factorisation of the augmented system.

use clarabel::algebra::CscMatrix;
use clarabel::qdldl::{QDLDLFactorisation, QDLDLSettingsBuilder};

use super::groups::Cone;
use super::program::Program;

/// Rounds of correction.
const ROUNDS: usize = 4;

/// Regularisation of the augmented system, for redundant equations.
const REGULARIZATION: f64 = 1e-10;

/// Corrects the scaled twists `v` in place; does nothing where every component
/// has a limit.
pub(super) fn respect_unlimited(program: &Program, v: &mut [f64]) {
    let free = program.groups.iter().filter(|group| group.cone == Cone::Free);
    let equations: Vec<Vec<(usize, f64)>> = free.map(|group| program.entries(group, 0)).collect();
    if equations.is_empty() {
        return;
    }
    let Some(mut factor) = factorise(v.len(), &equations) else { return };
    for _ in 0..ROUNDS {
        let mut rhs = vec![0.0; v.len() + equations.len()];
        for (violation, equation) in rhs[v.len()..].iter_mut().zip(&equations) {
            *violation = -equation.iter().map(|&(row, entry)| entry * v[row]).sum::<f64>();
        }
        factor.solve(&mut rhs);
        if !rhs.iter().all(|x| x.is_finite()) {
            return;
        }
        for (value, change) in v.iter_mut().zip(&rhs) {
            *value += change;
        }
    }
}

/// Factorises `[I C'; C -delta I]`, upper triangle by columns.
fn factorise(size: usize, equations: &[Vec<(usize, f64)>]) -> Option<QDLDLFactorisation<f64>> {
    let total = size + equations.len();
    let mut starts: Vec<usize> = (0..=size).collect();
    let mut rows: Vec<usize> = (0..size).collect();
    let mut values = vec![1.0; size];
    for (index, equation) in equations.iter().enumerate() {
        let mut entries = equation.clone();
        entries.sort_unstable_by_key(|entry| entry.0);
        rows.extend(entries.iter().map(|entry| entry.0));
        values.extend(entries.iter().map(|entry| entry.1));
        rows.push(size + index);
        values.push(-REGULARIZATION);
        starts.push(rows.len());
    }
    let signs = (0..total).map(|i| if i < size { 1 } else { -1 }).collect();
    let settings = QDLDLSettingsBuilder::default().Dsigns(signs).build().ok()?;
    QDLDLFactorisation::new(&CscMatrix::new(total, total, starts, rows, values), Some(settings)).ok()
}
