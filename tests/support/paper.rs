//! The formulation of the paper, as directly as it is stated: per connection a
//! wrench on the child and one on the parent, tied by equalities, a normal
//! support force, an adhesion force and a strength; per contact between bodies
//! a force on either; the largest utilisation is minimised. The second method in
//! tests and the baseline of benches. One standard solver's word, no proof.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
};
use nalgebra::Matrix3;
use steadfast::spatial::Vec3;
use steadfast::statics::{Anchor, Model, Structure};

/// What the solver says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// The utilisation, called solved.
    Utilisation(f64),
    /// No strength suffices.
    Infeasible,
    /// Anything else, with the utilisation that it had then; NaN when it had none.
    GaveUp(f64),
}

/// Asks the solver at `tolerance` for the utilisation alone.
pub fn solve(structure: &Structure, tolerance: f64) -> Answer {
    solve_weighted(structure, tolerance, 0.0).0
}

/// Asks the solver at `tolerance` for the least utilisation plus `weight` times the
/// sum, per typical force, of all strengths and of the normal forces of all contacts:
/// the utilisation and the terms of that sum in N, connections first.
pub fn solve_weighted(structure: &Structure, tolerance: f64, weight: f64) -> (Answer, Vec<f64>) {
    let program = Program::new(structure);
    let (width, height) = (program.columns.len(), program.rhs.len());
    let settings: Option<DefaultSettings<f64>> = DefaultSettingsBuilder::default()
        .verbose(false)
        .direct_solve_method("qdldl".to_owned())
        .max_threads(1)
        .tol_feas(tolerance)
        .tol_gap_abs(tolerance)
        .tol_gap_rel(tolerance)
        .build()
        .ok();
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for mut column in program.columns {
        column.sort_unstable_by_key(|entry| entry.0);
        rows.extend(column.iter().map(|entry| entry.0));
        values.extend(column.iter().map(|entry| entry.1));
        starts.push(rows.len());
    }
    let matrix = CscMatrix::new(height, width, starts, rows, values);
    let mut objective = vec![0.0; width];
    objective[0] = 1.0;
    for &column in &program.further {
        objective[column] = weight;
    }
    let nothing = CscMatrix::zeros((width, width));
    let solver =
        settings.and_then(|s| DefaultSolver::new(&nothing, &objective, &matrix, &program.rhs, &program.cones, s).ok());
    let Some(mut solver) = solver else { return (Answer::GaveUp(f64::NAN), Vec::new()) };
    solver.solve();
    let x = &solver.solution.x;
    let terms = program.further.iter().map(|&column| x[column] * program.force).collect();
    let answer = match solver.solution.status {
        SolverStatus::Solved => Answer::Utilisation(x[0]),
        SolverStatus::PrimalInfeasible => Answer::Infeasible,
        _ => Answer::GaveUp(x[0]),
    };
    (answer, terms)
}

/// `A x + s = b`, s in the cones; x_0 is the utilisation.
struct Program {
    columns: Vec<Vec<(usize, f64)>>,
    rhs: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    /// Strengths and normal forces of contacts: the further terms of the objective.
    further: Vec<usize>,
    /// Forces are counted in weights of a body, lengths in levers.
    force: f64,
    length: f64,
}

impl Program {
    fn new(structure: &Structure) -> Self {
        let mut program = Self {
            columns: vec![Vec::new()],
            rhs: Vec::new(),
            cones: Vec::new(),
            further: Vec::new(),
            force: typical_force(structure),
            length: typical_length(structure),
        };
        let first_row: Vec<Option<usize>> = structure
            .bodies
            .iter()
            .map(|body| (!body.fixed).then(|| program.rows(SupportedConeT::ZeroConeT(6), 6)))
            .collect();
        for (i, body) in structure.bodies.iter().enumerate() {
            program.apply(&first_row, i, structure.gravity * body.mass, Vec3::zeros());
        }
        for load in &structure.loads {
            let arm = load.at.map_or_else(Vec3::zeros, |at| at - structure.bodies[load.body].com);
            program.apply(&first_row, load.body, load.force, load.torque + arm.cross(&load.force));
        }
        for index in 0..structure.connections.len() {
            program.connection(structure, &first_row, index);
        }
        for index in 0..structure.contacts.len() {
            program.contact(structure, &first_row, index);
        }
        program
    }

    /// New rows in a cone.
    fn rows(&mut self, cone: SupportedConeT<f64>, count: usize) -> usize {
        let first = self.rhs.len();
        self.rhs.resize(first + count, 0.0);
        self.cones.push(cone);
        first
    }

    fn columns(&mut self, count: usize) -> usize {
        self.columns.resize(self.columns.len() + count, Vec::new());
        self.columns.len() - count
    }

    fn enter(&mut self, row: usize, column: usize, value: f64) {
        if value != 0.0 {
            self.columns[column].push((row, value));
        }
    }

    fn apply(&mut self, first_row: &[Option<usize>], body: usize, force: Vec3, torque: Vec3) {
        if let Some(row) = first_row[body] {
            for k in 0..3 {
                self.rhs[row + k] -= force[k] / self.force;
                self.rhs[row + 3 + k] -= torque[k] / (self.force * self.length);
            }
        }
    }

    /// Lets the force in columns `first..` and, if `torques`, the torque in the
    /// three after them, in the frame `axes` at `at`, act on `anchor`.
    fn act(
        &mut self,
        structure: &Structure,
        first_row: &[Option<usize>],
        anchor: Anchor,
        (at, axes): (Vec3, &Matrix3<f64>),
        first: usize,
        torques: bool,
    ) {
        let Anchor::Body(body) = anchor else { return };
        let Some(row) = first_row[body] else { return };
        let arm = (at - structure.bodies[body].com) / self.length;
        for k in 0..3 {
            let axis: Vec3 = axes.column(k).into();
            let moment = arm.cross(&axis);
            for r in 0..3 {
                self.enter(row + r, first + k, axis[r]);
                self.enter(row + 3 + r, first + k, moment[r]);
                if torques {
                    self.enter(row + 3 + r, first + 3 + k, axis[r]);
                }
            }
        }
    }

    /// `x + y = 0` for `count` pairs of columns.
    fn tie(&mut self, a: usize, b: usize, count: usize) {
        let row = self.rows(SupportedConeT::ZeroConeT(count), count);
        for k in 0..count {
            self.enter(row + k, a + k, 1.0);
            self.enter(row + k, b + k, 1.0);
        }
    }

    fn connection(&mut self, structure: &Structure, first_row: &[Option<usize>], index: usize) {
        let connection = &structure.connections[index];
        let connector = &structure.connectors[connection.connector];
        let axes = *connection.frame.rotation.to_rotation_matrix().matrix();
        let at = connection.frame.translation.vector;
        let (child, parent) = (self.columns(6), self.columns(6));
        let (normal, adhesion, strength) = (self.columns(1), self.columns(1), self.columns(1));
        self.further.push(strength);
        self.act(structure, first_row, connection.child, (at, &axes), child, true);
        self.act(structure, first_row, connection.parent, (at, &axes), parent, true);
        self.tie(child, parent, 6);
        // f_z = normal - adhesion, both at least zero, strength at most t times the rated one.
        let row = self.rows(SupportedConeT::ZeroConeT(1), 1);
        for (column, value) in [(child + 2, 1.0), (normal, -1.0), (adhesion, 1.0)] {
            self.enter(row, column, value);
        }
        let row = self.rows(SupportedConeT::NonnegativeConeT(3), 3);
        for (offset, column, value) in [(0, normal, -1.0), (1, adhesion, -1.0), (2, strength, 1.0)] {
            self.enter(row + offset, column, value);
        }
        self.enter(row + 2, 0, -connector.strength / self.force);
        match &connector.model {
            Model::Cone { friction, radius } => {
                self.limit_adhesion(adhesion, strength, 1.0);
                let head = self.rows(SupportedConeT::SecondOrderConeT(6), 6);
                self.enter(head, normal, -1.0);
                let sizes = [friction[0], friction[1], radius[0], radius[1], radius[2]];
                for (k, (column, size)) in [0, 1, 3, 4, 5].into_iter().zip(sizes).enumerate() {
                    let unit = if column < 3 { 1.0 } else { self.length };
                    self.enter(head + 1 + k, child + column, -unit / size);
                }
            }
            Model::Box { shear, tension, compression, bending, torsion } => {
                if tension.is_finite() {
                    self.limit_adhesion(adhesion, strength, tension / connector.strength);
                }
                if compression.is_finite() {
                    self.limit_adhesion(normal, strength, compression / connector.strength);
                }
                let limits = [shear[0], shear[1], bending[0], bending[1], *torsion];
                for (column, limit) in [0, 1, 3, 4, 5].into_iter().zip(limits).filter(|pair| pair.1.is_finite()) {
                    let unit = if column < 3 { 1.0 } else { 1.0 / self.length };
                    let row = self.rows(SupportedConeT::NonnegativeConeT(2), 2);
                    for (offset, sign) in [(0, 1.0), (1, -1.0)] {
                        self.enter(row + offset, child + column, sign);
                        self.enter(row + offset, strength, -limit * unit / connector.strength);
                    }
                }
            }
            Model::Patch { friction, points } => {
                self.limit_adhesion(adhesion, strength, 1.0);
                self.patch(child, normal, *friction, points);
            }
        }
    }

    /// `column <= share * strength`.
    fn limit_adhesion(&mut self, column: usize, strength: usize, share: f64) {
        let row = self.rows(SupportedConeT::NonnegativeConeT(1), 1);
        self.enter(row, column, 1.0);
        self.enter(row, strength, -share);
    }

    /// Point forces that add up to the wrench, their normals to the normal support.
    fn patch(&mut self, child: usize, normal: usize, friction: f64, points: &[[f64; 2]]) {
        let sums = self.rows(SupportedConeT::ZeroConeT(6), 6);
        for k in 0..6 {
            self.enter(sums + k, if k == 2 { normal } else { child + k }, -1.0);
        }
        for p in points {
            let force = self.columns(3);
            let arm = Vec3::new(p[0], p[1], 0.0) / self.length;
            for k in 0..3 {
                self.enter(sums + k, force + k, 1.0);
                let moment = arm.cross(&Vec3::ith(k, 1.0));
                for r in 0..3 {
                    self.enter(sums + 3 + r, force + k, moment[r]);
                }
            }
            self.friction_cone(force, friction);
        }
    }

    /// The force in three columns lies in the friction cone about its third.
    fn friction_cone(&mut self, force: usize, friction: f64) {
        if friction > 0.0 {
            let row = self.rows(SupportedConeT::SecondOrderConeT(3), 3);
            self.enter(row, force + 2, -friction);
            self.enter(row + 1, force, -1.0);
            self.enter(row + 2, force + 1, -1.0);
        } else {
            let row = self.rows(SupportedConeT::NonnegativeConeT(1), 1);
            self.enter(row, force + 2, -1.0);
            let row = self.rows(SupportedConeT::ZeroConeT(2), 2);
            self.enter(row, force, 1.0);
            self.enter(row + 1, force + 1, 1.0);
        }
    }

    fn contact(&mut self, structure: &Structure, first_row: &[Option<usize>], index: usize) {
        let contact = &structure.contacts[index];
        let normal = contact.normal.normalize();
        let x = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
        let y = normal.cross(&x).normalize();
        let axes = Matrix3::from_columns(&[y.cross(&normal), y, normal]);
        let force = self.columns(3);
        self.further.push(force + 2);
        self.act(structure, first_row, Anchor::Body(contact.body), (contact.position, &axes), force, false);
        self.friction_cone(force, contact.friction);
        if let Anchor::Body(_) = contact.against {
            let reaction = self.columns(3);
            self.act(structure, first_row, contact.against, (contact.position, &axes), reaction, false);
            self.tie(force, reaction, 3);
        }
    }
}

/// The mean weight and load of a body, in N.
pub fn typical_force(structure: &Structure) -> f64 {
    let weight = structure.bodies.iter().map(|body| body.mass).sum::<f64>() * structure.gravity.norm();
    let loads = structure.loads.iter().map(|load| load.force.norm()).sum::<f64>();
    let mean = (weight + loads) / structure.bodies.len().max(1) as f64;
    if mean > 0.0 { mean } else { 1.0 }
}

/// The mean distance of connections and contacts from centres of mass, in m.
pub fn typical_length(structure: &Structure) -> f64 {
    let mut levers = Vec::new();
    for connection in &structure.connections {
        for anchor in [connection.parent, connection.child] {
            if let Anchor::Body(i) = anchor {
                levers.push((connection.frame.translation.vector - structure.bodies[i].com).norm());
            }
        }
    }
    let contacts = structure.contacts.iter();
    levers.extend(contacts.map(|contact| (contact.position - structure.bodies[contact.body].com).norm()));
    let mean = levers.iter().sum::<f64>() / levers.len().max(1) as f64;
    if mean > 0.0 { mean } else { 1.0 }
}
