//! What is taken for the truth: utilisations with some fifteen digits more than
//! the methods have.
//!
//! Trees have a closed form, which is evaluated in double-double arithmetic.
//! Anything else is solved in that arithmetic as a cone program in standard
//! form. Neither knows the oracle's code, and either must agree with its bracket.

use std::fmt;

use clarabel::solver::{DefaultSettings, SolverStatus};
use steadfast::statics::{Anchor, Connector, Model, Question, Structure, assess};

use crate::double_double::DoubleDouble;
use crate::standard::{self, Vector, axes, cross, minus, number, plus, vector};

/// The utilisation and by how much it may be wrong.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    pub value: f64,
    pub uncertainty: f64,
}

/// Why there is no reference.
#[derive(Clone, Debug)]
pub enum Missing {
    /// The solver says that no strength suffices.
    Infeasible,
    /// The solver did not get to ten digits.
    Vague(f64),
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Infeasible => write!(f, "no strength suffices"),
            Self::Vague(uncertainty) => write!(f, "the reference is uncertain by {uncertainty:.0e}"),
        }
    }
}

/// Largest uncertainty, as a share of the larger of the utilisation and 1, that is accepted.
const VAGUE: f64 = 1e-10;

/// The reference for a structure, checked against the oracle's bracket.
///
/// # Panics
/// Where the oracle's bracket does not hold it: then one of the two is wrong, and
/// nothing measured afterwards means anything.
pub fn reference(structure: &Structure) -> Result<Reference, Missing> {
    let reference = match tree(structure) {
        Some(value) => {
            let value = f64::from(value);
            Reference { value, uncertainty: value * f64::EPSILON }
        }
        None => solved(structure)?,
    };
    let Reference { value, uncertainty } = reference;
    let proved = assess(structure, Question::ToGap(1e-9)).expect("the scenes are sound").utilisation;
    // The oracle takes data as meant up to 1e-12.
    let slack = uncertainty + 1e-12 * value;
    assert!(
        proved.lower - slack <= value && value <= proved.upper + slack,
        "the reference {value} +- {uncertainty:e} is not in the bracket [{}, {}]",
        proved.lower,
        proved.upper
    );
    Ok(reference)
}

/// The utilisation from the standard form in double-double arithmetic, solved in two
/// ways that must agree.
pub fn solved(structure: &Structure) -> Result<Reference, Missing> {
    let Reference { value, uncertainty } = estimated(structure)?;
    if uncertainty <= VAGUE * value.max(1.0) {
        Ok(Reference { value, uncertainty })
    } else {
        Err(Missing::Vague(uncertainty))
    }
}

/// The same with as many digits as the two ways have in common, however few.
pub fn estimated(structure: &Structure) -> Result<Reference, Missing> {
    let program = standard::program::<DoubleDouble>(structure);
    let [first, second] = [(true, 1e-16), (false, 1e-14)].map(|(equilibrate, regularization)| {
        let solution = program.solve(settings(equilibrate, regularization));
        solution.ok_or(Missing::Vague(f64::INFINITY))
    });
    let (first, second) = (first?, second?);
    if first.status == SolverStatus::DualInfeasible && second.status == SolverStatus::DualInfeasible {
        return Err(Missing::Infeasible);
    }
    let value = f64::from(first.value);
    let gap = f64::from(first.value - first.dual_value).abs();
    let apart = f64::from(first.value - second.value).abs();
    let residual = f64::from(first.residual).min(second.residual.into());
    Ok(Reference { value, uncertainty: gap + apart + (residual + f64::EPSILON) * value })
}

/// Settings for twice the digits. Less regularisation stalls earlier.
fn settings(equilibrate: bool, regularization: f64) -> DefaultSettings<DoubleDouble> {
    let wide = |value: f64| DoubleDouble::from(value);
    DefaultSettings {
        verbose: false,
        direct_solve_method: "qdldl".to_owned(),
        max_threads: 1,
        tol_feas: wide(1e-20),
        tol_gap_abs: wide(1e-20),
        tol_gap_rel: wide(1e-20),
        equilibrate_enable: equilibrate,
        static_regularization_constant: wide(regularization),
        static_regularization_proportional: wide(0.0),
        dynamic_regularization_eps: wide(1e-28),
        dynamic_regularization_delta: wide(1e-13),
        iterative_refinement_reltol: wide(1e-30),
        iterative_refinement_abstol: wide(1e-30),
        ..DefaultSettings::default()
    }
}

type Wide = Vector<DoubleDouble>;

/// The utilisation of a tree on the world, without contacts or patches, in closed
/// form: every connection carries what hangs on it. `None` for anything else.
pub fn tree(structure: &Structure) -> Option<DoubleDouble> {
    let count = structure.bodies.len();
    if !structure.contacts.is_empty() || structure.connections.len() != count {
        return None;
    }
    let mut links: Vec<Vec<usize>> = vec![Vec::new(); count + 1];
    let vertex = |anchor: Anchor| match anchor {
        Anchor::World => count,
        Anchor::Body(i) => i,
    };
    for (l, connection) in structure.connections.iter().enumerate() {
        links[vertex(connection.parent)].push(l);
        links[vertex(connection.child)].push(l);
    }
    // Outwards from the world: (body, the connection it hangs on).
    let (mut order, mut above) = (Vec::with_capacity(count), vec![count; count]);
    let mut seen = vec![false; count + 1];
    seen[count] = true;
    let mut open = vec![count];
    while let Some(from) = open.pop() {
        for &l in &links[from] {
            let connection = &structure.connections[l];
            let ends = [vertex(connection.parent), vertex(connection.child)];
            let to = if ends[0] == from { ends[1] } else { ends[0] };
            if !seen[to] {
                seen[to] = true;
                above[to] = from;
                order.push((to, l));
                open.push(to);
            }
        }
    }
    if order.len() < count || structure.bodies.iter().any(|body| body.fixed) {
        return None;
    }
    let com: Vec<Wide> = structure.bodies.iter().map(|body| vector(body.com)).collect();
    let (mut force, mut torque) = own_loads(structure, &com);
    let mut largest = DoubleDouble::default();
    for &(body, l) in order.iter().rev() {
        let connection = &structure.connections[l];
        let arm = minus(com[body], vector(connection.frame.translation.vector));
        let moment = plus(torque[body], cross(arm, force[body]));
        // The connection holds the body against its load; its wrench is the one on the child.
        let sign = if vertex(connection.child) == body { -1.0 } else { 1.0 };
        let local = |v: &Wide| axes::<DoubleDouble>(connection).map(|axis| dot(&axis, v) * number(sign));
        let connector = &structure.connectors[connection.connector];
        let demand = utilisation(connector, &local(&force[body]), &local(&moment))?;
        if demand > largest {
            largest = demand;
        }
        if above[body] < count {
            let next = above[body];
            let carried = cross(minus(com[body], com[next]), force[body]);
            torque[next] = plus(torque[next], plus(torque[body], carried));
            force[next] = plus(force[next], force[body]);
        }
    }
    Some(largest)
}

/// Force and torque about the centre of mass on every body.
fn own_loads(structure: &Structure, com: &[Wide]) -> (Vec<Wide>, Vec<Wide>) {
    let gravity: Wide = vector(structure.gravity);
    let mut force: Vec<Wide> = structure.bodies.iter().map(|body| gravity.map(|g| g * number(body.mass))).collect();
    let mut torque = vec![[DoubleDouble::default(); 3]; force.len()];
    for load in &structure.loads {
        let (i, applied) = (load.body, vector(load.force));
        force[i] = plus(force[i], applied);
        torque[i] = plus(torque[i], vector(load.torque));
        if let Some(at) = load.at {
            torque[i] = plus(torque[i], cross(minus(vector(at), com[i]), applied));
        }
    }
    (force, torque)
}

fn dot(a: &Wide, b: &Wide) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// What a wrench demands of a connector; `None` for patches, which need a program of their own.
fn utilisation(connector: &Connector, force: &Wide, torque: &Wide) -> Option<DoubleDouble> {
    use num_traits::Float;
    let zero = DoubleDouble::default();
    match &connector.model {
        Model::Cone { friction: [a, b], radius: [c, d, e] } => {
            let over = |x: DoubleDouble, size: f64| (x / number(size)) * (x / number(size));
            let squares = over(force[0], *a) + over(force[1], *b) + over(torque[0], *c) + over(torque[1], *d);
            let length = (squares + over(torque[2], *e)).sqrt();
            Some((length - force[2]).max(zero) / number(connector.strength))
        }
        Model::Box { shear, tension, compression, bending, torsion } => {
            let normal = if force[2] < zero { *tension } else { *compression };
            let limits = [shear[0], shear[1], normal, bending[0], bending[1], *torsion];
            let ratios = force.iter().chain(torque).zip(limits).filter(|(_, limit)| limit.is_finite());
            let ratios = ratios.map(|(x, limit)| if *x == zero { zero } else { x.abs() / number(limit) });
            Some(ratios.fold(zero, Float::max))
        }
        Model::Patch { .. } => None,
    }
}
