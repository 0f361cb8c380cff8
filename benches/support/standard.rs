//! The standard form: one wrench per connection, and the wrench itself, shifted
//! by the preload, is the cone variable. The plain program, as anyone would write it down who
//! knows second-order cones: nothing left out, no bounds, forces counted in mean
//! weights and lengths in mean levers. Shares no code with the oracle.

use clarabel::algebra::FloatT;
use steadfast::statics::{Anchor, Connection, Contact, Model, Structure};

use crate::cone_program::{Column, Cone, ConeProgram};
use crate::paper::{typical_force, typical_length};

/// A vector of the number type of the program.
pub type Vector<T> = [T; 3];

/// A wrench about a point.
#[derive(Clone, Copy)]
struct Wrench<T> {
    force: Vector<T>,
    torque: Vector<T>,
}

/// Where a wrench acts, and on what: `plus` feels it, `minus` its opposite.
struct Site<T> {
    plus: Anchor,
    minus: Anchor,
    at: Vector<T>,
    axes: [Vector<T>; 3],
}

/// The program whose optimal value is the utilisation t, with t as its first variable.
pub fn program<T: FloatT>(structure: &Structure) -> ConeProgram<T> {
    let mut builder = Builder::new(structure);
    for connection in &structure.connections {
        builder.connection(connection);
    }
    for contact in &structure.contacts {
        builder.contact(contact);
    }
    builder.program
}

struct Builder<'s, T> {
    structure: &'s Structure,
    program: ConeProgram<T>,
    first_row: Vec<Option<usize>>,
    force: T,
    length: T,
}

impl<'s, T: FloatT> Builder<'s, T> {
    fn new(structure: &'s Structure) -> Self {
        let mut program = ConeProgram { rhs: Vec::new(), columns: Vec::new(), groups: Vec::new() };
        program.group(Cone::NonNegative, [Column { cost: T::one(), entries: Vec::new() }]);
        let first_row = structure.bodies.iter().map(|body| (!body.fixed).then(|| program.rows(6))).collect();
        let (force, length) = (number(typical_force(structure)), number(typical_length(structure)));
        let mut builder = Self { structure, program, first_row, force, length };
        let gravity: Vector<T> = vector(structure.gravity);
        for (i, body) in structure.bodies.iter().enumerate() {
            builder.load(i, gravity.map(|g| g * number(body.mass)), [T::zero(); 3]);
        }
        for load in &structure.loads {
            let (force, torque) = (vector(load.force), vector(load.torque));
            let com = vector(structure.bodies[load.body].com);
            let moment = load.at.map_or([T::zero(); 3], |at| cross(minus(vector(at), com), force));
            builder.load(load.body, force, plus(torque, moment));
        }
        builder
    }

    fn load(&mut self, body: usize, force: Vector<T>, torque: Vector<T>) {
        if let Some(row) = self.first_row[body] {
            for k in 0..3 {
                self.program.rhs[row + k] -= force[k] / self.force;
                self.program.rhs[row + 3 + k] -= torque[k] / (self.force * self.length);
            }
        }
    }

    /// Balance coefficients of a wrench that is given in the site's frame about its point.
    fn column(&self, site: &Site<T>, local: &Wrench<T>) -> Column<T> {
        let world = |v: &Vector<T>| {
            std::array::from_fn(|r| site.axes[0][r] * v[0] + site.axes[1][r] * v[1] + site.axes[2][r] * v[2])
        };
        let (force, torque): (Vector<T>, Vector<T>) = (world(&local.force), world(&local.torque));
        let mut entries = Vec::with_capacity(12);
        for (anchor, sign) in [(site.plus, T::one()), (site.minus, -T::one())] {
            let Anchor::Body(body) = anchor else { continue };
            let Some(row) = self.first_row[body] else { continue };
            let arm = minus(site.at, vector(self.structure.bodies[body].com));
            let moment = plus(torque, cross(arm, force));
            for k in 0..3 {
                for (row, value) in [(row + k, force[k]), (row + 3 + k, moment[k] / self.length)] {
                    if value != T::zero() {
                        entries.push((row, sign * value));
                    }
                }
            }
        }
        Column { cost: T::zero(), entries }
    }

    /// A force along z with a torque about the site's point, both per unit of the program.
    fn pure(&self, component: usize, size: T) -> Wrench<T> {
        let mut local = Wrench { force: [T::zero(); 3], torque: [T::zero(); 3] };
        if component < 3 {
            local.force[component] = size;
        } else {
            local.torque[component - 3] = size;
        }
        local
    }

    fn connection(&mut self, connection: &Connection) {
        let site = Site {
            plus: connection.child,
            minus: connection.parent,
            at: vector(connection.frame.translation.vector),
            axes: axes(connection),
        };
        let connector = &self.structure.connectors[connection.connector];
        match &connector.model {
            Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                let sizes = [(2, 1.0), (0, *a), (1, *b), (3, *c), (4, *d), (5, *e)];
                let columns = sizes.map(|(k, size)| self.column(&site, &self.pure(k, number(size))));
                self.program.group(Cone::Lorentz, columns);
                self.preload(&site, 2, -connector.strength);
            }
            Model::Patch { friction, points } => {
                for &[x, y] in points {
                    self.friction_cone(&site, *friction, [number(x), number(y), T::zero()]);
                }
                self.preload(&site, 2, -connector.strength);
            }
            Model::Box { shear, tension, compression, bending, torsion } => {
                let limits = [
                    [shear[0]; 2],
                    [shear[1]; 2],
                    [*tension, *compression],
                    [bending[0]; 2],
                    [bending[1]; 2],
                    [*torsion; 2],
                ];
                for (component, limits) in limits.into_iter().enumerate() {
                    self.limited(&site, component, limits);
                }
            }
        }
    }

    /// One component of a wrench, at least `-t low` and at most `t high`.
    fn limited(&mut self, site: &Site<T>, component: usize, [low, high]: [f64; 2]) {
        // Torques are counted per length, so that all slacks are alike in size.
        let unit = if component < 3 { T::one() } else { self.length };
        let rising = self.column(site, &self.pure(component, unit));
        match (low.is_finite(), high.is_finite()) {
            (false, false) => {
                self.program.group(Cone::Free, [rising]);
            }
            (true, false) => {
                self.program.group(Cone::NonNegative, [rising]);
                self.preload(site, component, -low);
            }
            (false, true) => {
                let falling = self.column(site, &self.pure(component, -unit));
                self.program.group(Cone::NonNegative, [falling]);
                self.preload(site, component, high);
            }
            (true, true) => {
                // (t low + w) + (t high - w) = t (low + high), each slack at least zero.
                let tie = self.program.rows(1);
                let mut slack = rising;
                slack.entries.push((tie, T::one()));
                let other = Column { cost: T::zero(), entries: vec![(tie, T::one())] };
                self.program.group(Cone::NonNegative, [slack, other]);
                self.preload(site, component, -low);
                let width: T = number(low + high);
                self.program.columns[0].entries.push((tie, -width / (self.force * unit)));
            }
        }
    }

    /// Adds to the column of t the given size of a wrench component, in N or N m.
    fn preload(&mut self, site: &Site<T>, component: usize, size: f64) {
        let column = self.column(site, &self.pure(component, number::<T>(size) / self.force));
        self.program.columns[0].entries.extend(column.entries);
    }

    fn friction_cone(&mut self, site: &Site<T>, friction: f64, at: Vector<T>) {
        let force = |k: usize, size: f64| {
            let force = self.pure(k, number(size)).force;
            self.column(site, &Wrench { force, torque: cross(at, force) })
        };
        if friction > 0.0 {
            let columns = [force(2, 1.0), force(0, friction), force(1, friction)];
            self.program.group(Cone::Lorentz, columns);
        } else {
            let column = force(2, 1.0);
            self.program.group(Cone::NonNegative, [column]);
        }
    }

    fn contact(&mut self, contact: &Contact) {
        let normal = unit(vector(contact.normal));
        let aside = if contact.normal.x.abs() < 0.6 { 0 } else { 1 };
        let mut other = [T::zero(); 3];
        other[aside] = T::one();
        let y = unit(cross(normal, other));
        let site = Site {
            plus: Anchor::Body(contact.body),
            minus: contact.against,
            at: vector(contact.position),
            axes: [cross(y, normal), y, normal],
        };
        self.friction_cone(&site, contact.friction, [T::zero(); 3]);
    }
}

/// The axes of a connection's frame, from its quaternion made one of unit length.
pub fn axes<T: FloatT>(connection: &Connection) -> [Vector<T>; 3] {
    let q = connection.frame.rotation.as_ref();
    let [x, y, z, w]: [T; 4] = [q.i, q.j, q.k, q.w].map(number);
    let scale = number::<T>(2.0) / (x * x + y * y + z * z + w * w);
    let one = T::one();
    [
        [one - scale * (y * y + z * z), scale * (x * y + w * z), scale * (x * z - w * y)],
        [scale * (x * y - w * z), one - scale * (x * x + z * z), scale * (y * z + w * x)],
        [scale * (x * z + w * y), scale * (y * z - w * x), one - scale * (x * x + y * y)],
    ]
}

/// A number as one of the type of the program.
pub fn number<T: FloatT>(value: f64) -> T {
    T::from_f64(value).expect("every number type here holds all f64")
}

/// A vector as one of the type of the program.
pub fn vector<T: FloatT>(v: steadfast::spatial::Vec3) -> Vector<T> {
    [v.x, v.y, v.z].map(number)
}

/// The sum of two vectors.
pub fn plus<T: FloatT>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| a[k] + b[k])
}

/// The difference of two vectors.
pub fn minus<T: FloatT>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    std::array::from_fn(|k| a[k] - b[k])
}

/// The vector product.
pub fn cross<T: FloatT>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit<T: FloatT>(v: Vector<T>) -> Vector<T> {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}
