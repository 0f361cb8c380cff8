//! Judges an answer of the oracle from its fields and the structure alone, with
//! equations written down a second time.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::{Matrix3, Vector6};
use steadfast::spatial::{Twist, Vec3, Wrench};
use steadfast::statics::{Anchor, Assessment, Connector, Model, Structure};

/// Relative tolerance of every check.
const TOLERANCE: f64 = 1e-9;

/// Finds fault with an answer to [`steadfast::statics::Question::VALUE`].
///
/// # Errors
/// What is wrong, in words.
pub fn recheck(structure: &Structure, answer: &Assessment) -> Result<(), String> {
    let (lower, upper) = (answer.utilisation.lower, answer.utilisation.upper);
    if !(0.0 <= lower && lower <= upper) {
        return Err(format!("not a bracket: [{lower}, {upper}]"));
    }
    if lower.is_infinite() {
        return collapses(structure, answer);
    }
    if upper.is_finite() {
        balances(structure, answer)?;
        holds(structure, answer)?;
    }
    if lower > 0.0 { fails_below(structure, answer) } else { Ok(()) }
}

fn movable(structure: &Structure, anchor: Anchor) -> Option<usize> {
    match anchor {
        Anchor::Body(i) if !structure.bodies[i].fixed => Some(i),
        Anchor::Body(_) | Anchor::World => None,
    }
}

fn balances(structure: &Structure, answer: &Assessment) -> Result<(), String> {
    let count = structure.bodies.len();
    let (mut sum, mut size) = (vec![Wrench::ZERO; count], vec![(0.0, 0.0); count]);
    let mut act = |anchor: Anchor, force: Vec3, torque: Vec3, at: Vec3| {
        if let Some(i) = movable(structure, anchor) {
            let arm = at - structure.bodies[i].com;
            sum[i] += Wrench::new(force, torque + arm.cross(&force));
            size[i].0 += force.norm();
            size[i].1 += torque.norm() + arm.norm() * force.norm();
        }
    };
    for (connection, state) in structure.connections.iter().zip(&answer.connections) {
        let (axes, at) = (connection.frame.rotation, connection.frame.translation.vector);
        let (force, torque) = (axes * state.wrench.force, axes * state.wrench.torque);
        act(connection.child, force, torque, at);
        act(connection.parent, -force, -torque, at);
    }
    for (contact, force) in structure.contacts.iter().zip(&answer.contacts) {
        act(Anchor::Body(contact.body), *force, Vec3::zeros(), contact.position);
        act(contact.against, -force, Vec3::zeros(), contact.position);
    }
    for (i, body) in structure.bodies.iter().enumerate() {
        act(Anchor::Body(i), structure.gravity * body.mass, Vec3::zeros(), body.com);
    }
    for load in &structure.loads {
        let at = load.at.unwrap_or(structure.bodies[load.body].com);
        act(Anchor::Body(load.body), load.force, load.torque, at);
    }
    // Next to nothing, compared with what the structure holds, is noise.
    let most = size.iter().fold((0.0_f64, 0.0_f64), |most, size| (most.0.max(size.0), most.1.max(size.1)));
    for (i, (wrench, size)) in sum.iter().zip(size).enumerate() {
        let (force, torque) = (size.0 + 1e-8 * most.0, size.1 + 1e-8 * most.1);
        if !(wrench.force.norm() <= TOLERANCE * force && wrench.torque.norm() <= TOLERANCE * torque) {
            return Err(format!("body {i} lacks {wrench:?} of {force} N, {torque} N m"));
        }
    }
    Ok(())
}

fn holds(structure: &Structure, answer: &Assessment) -> Result<(), String> {
    // Contacts that carry nothing but rounding of the loads are not judged by it.
    let weights = structure.bodies.iter().map(|body| body.mass * structure.gravity.norm());
    let loads = weights.chain(structure.loads.iter().map(|load| load.force.norm())).fold(0.0, f64::max);
    let typical = answer.contacts.iter().map(Vec3::norm).fold(1e-6 * loads, f64::max);
    for (i, (contact, force)) in structure.contacts.iter().zip(&answer.contacts).enumerate() {
        let normal = force.dot(&contact.normal);
        let shear = (force - contact.normal * normal).norm();
        let slip = TOLERANCE * typical;
        if !(normal >= -slip && shear <= contact.friction * normal.max(0.0) + slip) {
            return Err(format!("contact {i} presses with {normal} and rubs with {shear} N"));
        }
    }
    let upper = answer.utilisation.upper;
    for (i, (connection, state)) in structure.connections.iter().zip(&answer.connections).enumerate() {
        let connector = &structure.connectors[connection.connector];
        let (needed, accuracy) = utilisation(connector, &state.wrench);
        let room = |t: f64| t * (1.0 + accuracy) + accuracy * state.wrench.force.norm() / connector.strength;
        if !(needed <= room(state.utilisation) && state.utilisation <= upper) {
            return Err(format!("connection {i} needs {needed}, states {}, bound {upper}", state.utilisation));
        }
        if !((state.strength - state.utilisation * connector.strength).abs() <= TOLERANCE * state.strength) {
            return Err(format!("connection {i}: strength {} and {}", state.strength, state.utilisation));
        }
    }
    Ok(())
}

/// The utilisation that a wrench demands of a connector and its relative accuracy.
fn utilisation(connector: &Connector, wrench: &Wrench) -> (f64, f64) {
    let (f, m) = (&wrench.force, &wrench.torque);
    match &connector.model {
        Model::Cone { friction, radius } => {
            let rest = [f.x / friction[0], f.y / friction[1], m.x / radius[0], m.y / radius[1], m.z / radius[2]];
            let length = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
            ((length - f.z).max(0.0) / connector.strength, TOLERANCE)
        }
        Model::Box { shear, tension, compression, bending, torsion } => {
            let (force, torque) = (f.norm(), m.norm());
            let ratio = |x: f64, limit: f64, size: f64| {
                if x.abs() <= 1e-11 * size { 0.0 } else { x.abs() / limit }
            };
            let normal = if f.z < 0.0 { *tension } else { *compression };
            let forces = [ratio(f.x, shear[0], force), ratio(f.y, shear[1], force), ratio(f.z, normal, force)];
            let torques =
                [ratio(m.x, bending[0], torque), ratio(m.y, bending[1], torque), ratio(m.z, *torsion, torque)];
            (forces.into_iter().chain(torques).fold(0.0, f64::max), TOLERANCE)
        }
        Model::Patch { friction, points } => {
            (least_preload(wrench, *friction, points).unwrap_or(0.0) / connector.strength, 1e-6)
        }
    }
}

/// The preload of a patch, as a cone program of its own: forces `(x, y, z)` per
/// point that add up to `wrench` and the preload, shear and torsion over the friction
/// so that the program stays well scaled. `None` where the solver gives up.
pub fn least_preload(wrench: &Wrench, friction: f64, points: &[[f64; 2]]) -> Option<f64> {
    let lever = points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let grip = if friction > 0.0 { friction } else { 1.0 };
    let force = wrench.force.component_div(&Vec3::new(grip, grip, 1.0));
    let torque = wrench.torque.component_div(&Vec3::new(1.0, 1.0, grip));
    let scale = force.norm() + torque.norm() / lever;
    if scale == 0.0 {
        return Some(0.0);
    }
    // Rows: six balances, s >= 0, then a cone (friction z, x, y) per point.
    let (mut columns, mut height) = (Vec::new(), 7);
    for p in points {
        let arm = Vec3::new(p[0] / lever, p[1] / lever, 0.0);
        for k in 0..3 {
            let force = Vec3::ith(k, 1.0);
            let torque = arm.cross(&force);
            let mut column: Vec<(usize, f64)> = force.iter().chain(&torque).copied().enumerate().collect();
            column.push((height + (k + 1) % 3, if k == 2 { -friction / grip } else { -1.0 }));
            columns.push(column);
        }
        height += 3;
    }
    columns.push(vec![(2, -1.0), (6, -1.0)]);
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in &columns {
        for &(row, value) in column.iter().filter(|entry| entry.1 != 0.0) {
            rows.push(row);
            values.push(value);
        }
        starts.push(rows.len());
    }
    let width = columns.len();
    let matrix = CscMatrix::new(height, width, starts, rows, values);
    let mut rhs = vec![0.0; height];
    let (f, m) = (force / scale, torque / (scale * lever));
    rhs[..6].copy_from_slice(&[f.x, f.y, f.z, m.x, m.y, m.z]);
    let mut objective = vec![0.0; width];
    objective[width - 1] = 1.0;
    let mut cones = vec![SupportedConeT::ZeroConeT(6), SupportedConeT::NonnegativeConeT(1)];
    cones.extend(points.iter().map(|_| SupportedConeT::SecondOrderConeT(3)));
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .presolve_enable(false)
        .direct_solve_method("qdldl".to_owned())
        .tol_feas(1e-10)
        .tol_gap_abs(1e-10)
        .tol_gap_rel(1e-10)
        .build()
        .ok()?;
    let nothing = CscMatrix::zeros((width, width));
    let mut solver = DefaultSolver::new(&nothing, &objective, &matrix, &rhs, &cones, settings).ok()?;
    solver.solve();
    (solver.solution.status == SolverStatus::Solved).then_some(solver.solution.obj_val * scale)
}

/// Twist of `plus` against `minus` at `at`, in the frame `axes`, and the sizes of
/// the terms in its two parts.
fn relative(
    structure: &Structure,
    answer: &Assessment,
    plus: Anchor,
    minus: Anchor,
    at: Vec3,
    axes: &Matrix3<f64>,
) -> (Twist, [f64; 2]) {
    let (mut linear, mut angular, mut sizes) = (Vec3::zeros(), Vec3::zeros(), [0.0; 2]);
    for (anchor, sign) in [(plus, 1.0), (minus, -1.0)] {
        if let Some(i) = movable(structure, anchor) {
            let (twist, arm) = (&answer.mechanism[i], at - structure.bodies[i].com);
            linear += (twist.linear + twist.angular.cross(&arm)) * sign;
            angular += twist.angular * sign;
            sizes[0] += twist.linear.norm() + twist.angular.norm() * (arm.norm() + at.norm() + 1e-9);
            sizes[1] += twist.angular.norm();
        }
    }
    (Twist::new(axes.transpose() * linear, axes.transpose() * angular), sizes)
}

/// Power of gravity and loads in the mechanism, and the size of its terms.
fn power(structure: &Structure, answer: &Assessment) -> (f64, f64) {
    let (mut total, mut size) = (0.0, 0.0);
    let mut add = |body: usize, force: Vec3, torque: Vec3, arm: Vec3| {
        if !structure.bodies[body].fixed {
            let twist = &answer.mechanism[body];
            let terms = [force.dot(&twist.linear), (torque + arm.cross(&force)).dot(&twist.angular)];
            total += terms[0] + terms[1];
            size +=
                force.norm() * twist.linear.norm() + (torque.norm() + arm.norm() * force.norm()) * twist.angular.norm();
        }
    };
    for (i, body) in structure.bodies.iter().enumerate() {
        add(i, structure.gravity * body.mass, Vec3::zeros(), Vec3::zeros());
    }
    for load in &structure.loads {
        let arm = load.at.map_or_else(Vec3::zeros, |at| at - structure.bodies[load.body].com);
        add(load.body, load.force, load.torque, arm);
    }
    (total, size)
}

/// By how much the contacts and connections resist the mechanism, in m/s, the size of the terms
/// in that, and what the connections dissipate at their rated strengths, at least, as far as
/// rounding tells: bodies that move fast together leave some of it in every connection
/// between them. `rigid` treats every limit above zero as unlimited.
fn resistance(structure: &Structure, answer: &Assessment, rigid: bool) -> (f64, f64, f64) {
    let (mut worst, mut fastest, mut dissipation) = (0.0_f64, 0.0_f64, 0.0);
    let at_least = |speed: f64, size: f64| (speed - 4.0 * f64::EPSILON * size).max(0.0);
    for contact in &structure.contacts {
        let axes = Matrix3::identity();
        let pair = (Anchor::Body(contact.body), contact.against);
        let (twist, [size, _]) = relative(structure, answer, pair.0, pair.1, contact.position, &axes);
        let opening = twist.linear.dot(&contact.normal);
        let sliding = (twist.linear - contact.normal * opening).norm();
        fastest = fastest.max(size);
        worst = worst.max(contact.friction * sliding - opening);
    }
    for connection in &structure.connections {
        let connector = &structure.connectors[connection.connector];
        let axes = *connection.frame.rotation.to_rotation_matrix().matrix();
        let at = connection.frame.translation.vector;
        let (twist, [size, turning]) = relative(structure, answer, connection.child, connection.parent, at, &axes);
        fastest = fastest.max(size);
        let (v, w) = (&twist.linear, &twist.angular);
        let components = Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z);
        match &connector.model {
            Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                let rubbing = [a * v.x, b * v.y, c * w.x, d * w.y, e * w.z].map(|x| x * x).iter().sum::<f64>().sqrt();
                worst = worst.max(if rigid { components.norm() } else { rubbing - v.z });
                dissipation += connector.strength * at_least(v.z, size);
            }
            Model::Box { shear, tension, compression, bending, torsion } => {
                let limits = [
                    (shear[0], shear[0]),
                    (shear[1], shear[1]),
                    (*tension, *compression),
                    (bending[0], bending[0]),
                    (bending[1], bending[1]),
                    (*torsion, *torsion),
                ];
                let sizes = [size, size, size, turning, turning, turning];
                for ((velocity, size), (opening, closing)) in components.iter().zip(sizes).zip(limits) {
                    let limit = if *velocity > 0.0 { opening } else { closing };
                    if limit.is_infinite() || (rigid && limit > 0.0) {
                        worst = worst.max(velocity.abs());
                    } else {
                        dissipation += limit * at_least(velocity.abs(), size);
                    }
                }
            }
            Model::Patch { friction, points } => {
                for p in points {
                    let here = v + w.cross(&Vec3::new(p[0], p[1], 0.0));
                    worst = worst.max(friction * here.xy().norm() - here.z);
                }
                worst = worst.max(if rigid { v.z.abs() } else { 0.0 });
                dissipation += connector.strength * at_least(v.z, size);
            }
        }
    }
    (worst, fastest, dissipation)
}

/// Below the lower bound the loads do more work in the mechanism than can be dissipated.
fn fails_below(structure: &Structure, answer: &Assessment) -> Result<(), String> {
    let lower = answer.utilisation.lower;
    let (power, size) = power(structure, answer);
    let (worst, fastest, dissipation) = resistance(structure, answer, false);
    if !(worst <= 1e-10 * fastest) {
        return Err(format!("the mechanism is resisted at {worst} of {fastest} m/s"));
    }
    if !(power + 1e-12 * size >= lower * dissipation * (1.0 - TOLERANCE) && dissipation > 0.0) {
        return Err(format!("power {power} over dissipation {dissipation} is not {lower}"));
    }
    Ok(())
}

/// Nothing resists the mechanism however strong the connections, and the loads work in it.
fn collapses(structure: &Structure, answer: &Assessment) -> Result<(), String> {
    let (power, size) = power(structure, answer);
    let (worst, fastest, _) = resistance(structure, answer, true);
    if !(power > 1e-12 * size) {
        return Err(format!("the collapse does no work: {power} of {size}"));
    }
    // What resists at rounding could save it only with forces beyond all measure.
    let force = structure.bodies.iter().map(|body| body.mass).sum::<f64>() * structure.gravity.norm()
        + structure.loads.iter().map(|load| load.force.norm()).sum::<f64>();
    if !(worst <= 1e-12 * fastest || worst * force <= 1e-7 * power) {
        return Err(format!("the collapse is resisted at {worst} of {fastest} m/s, power {power}"));
    }
    Ok(())
}
