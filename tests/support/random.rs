//! Random structures: polycubes with jittered centres of mass, held by every
//! kind of connector and contact. A recipe always gives the same structure.

use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Contact, Load, Model, Structure};

/// Which range of data a structure is drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Desktop robots: every model, both supports, friction 0.2 to 1.
    Ordinary,
    /// Masses over six decades.
    Masses,
    /// Rated strengths over six decades.
    Strengths,
    /// Radii of `cone` connectors down to 1e-6 m.
    Radii,
    /// Friction of 0, 1e-6 or 1e3 beside ordinary friction.
    Friction,
    /// Cells of a micrometre.
    Micro,
    /// Cells of a kilometre.
    Giga,
    /// Only contacts, in nearly collinear triples, hold it to the world.
    Collinear,
    /// Clamped between many fixed bodies, often with nothing to do.
    Clamped,
    /// Every face pair is connected, some twice.
    Redundant,
    /// Boxes with limits of zero and without limits.
    Hinged,
    /// Masses and rated strengths log-normal with deviation 3: over ten decades.
    LogNormal,
    /// Stands on ground that is inclined another way under every cell.
    Uneven,
    /// Forces and torques on most bodies, acting away from their centres.
    Loaded,
    /// Stands freely on the ground, neighbours joined or only touching.
    Standing,
    /// Long and thin.
    Slender,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 16] = [
        Self::Ordinary,
        Self::Masses,
        Self::Strengths,
        Self::Radii,
        Self::Friction,
        Self::Micro,
        Self::Giga,
        Self::Collinear,
        Self::Clamped,
        Self::Redundant,
        Self::Hinged,
        Self::LogNormal,
        Self::Uneven,
        Self::Loaded,
        Self::Standing,
        Self::Slender,
    ];
}

/// What determines a random structure.
#[derive(Clone, Copy, Debug)]
pub struct Recipe {
    /// The range of data.
    pub kind: Kind,
    /// Number of bodies, at least 1.
    pub bodies: usize,
    /// Seed of everything else.
    pub seed: u64,
}

/// A small deterministic random number generator (SplitMix64, Steele et al. 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator with its own sequence for every seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform between `low` and `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in the logarithm between `low` and `high`, both positive.
    pub fn decade(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// Log-normal: the logarithm has deviation `sigma` about that of `median`
    /// (Box and Muller 1958).
    pub fn lognormal(&mut self, median: f64, sigma: f64) -> f64 {
        let radius = (-2.0 * (1.0 - self.between(0.0, 1.0)).ln()).sqrt();
        median * (sigma * radius * (std::f64::consts::TAU * self.between(0.0, 1.0)).cos()).exp()
    }

    /// True with probability `p`.
    pub fn chance(&mut self, p: f64) -> bool {
        self.between(0.0, 1.0) < p
    }

    /// An index below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// A vector with components between -1 and 1.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.between(-1.0, 1.0))
    }

    /// Any rotation.
    pub fn rotation(&mut self) -> Rotation {
        Rotation::from_scaled_axis(self.vector() * std::f64::consts::PI)
    }
}

const DIRECTIONS: [[i32; 3]; 6] = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];

fn direction(cell: [i32; 3]) -> Vec3 {
    Vec3::from_iterator(cell.iter().map(|&x| f64::from(x)))
}

/// The structure of a recipe.
pub fn structure(recipe: &Recipe) -> Structure {
    let mut builder = Builder::new(recipe);
    let cells = builder.grow(recipe.bodies);
    for cell in &cells {
        builder.add_body(*cell);
    }
    builder.add_connectors();
    builder.join(&cells);
    builder.support(&cells);
    builder.load();
    let turn = if builder.random.chance(0.5) { builder.random.rotation() } else { Rotation::identity() };
    let shift = builder.random.vector() * (3.0 * builder.pitch);
    moved(&builder.structure, &Pose::from_parts(shift.into(), turn))
}

/// The structure after a rigid motion of everything in it, gravity and loads included.
pub fn moved(structure: &Structure, motion: &Pose) -> Structure {
    let (point, turned) = (|p: &Vec3| motion * nalgebra::Point3::from(*p), |v: &Vec3| motion.rotation * v);
    let mut result = structure.clone();
    result.gravity = turned(&structure.gravity);
    for body in &mut result.bodies {
        body.com = point(&body.com).coords;
    }
    for connection in &mut result.connections {
        connection.frame = motion * connection.frame;
    }
    for contact in &mut result.contacts {
        contact.position = point(&contact.position).coords;
        contact.normal = turned(&contact.normal);
    }
    for load in &mut result.loads {
        load.force = turned(&load.force);
        load.torque = turned(&load.torque);
        load.at = load.at.map(|at| point(&at).coords);
    }
    result
}

struct Builder {
    kind: Kind,
    random: Random,
    pitch: f64,
    structure: Structure,
}

impl Builder {
    fn new(recipe: &Recipe) -> Self {
        let mut random = Random::new(recipe.seed);
        let pitch = match recipe.kind {
            Kind::Micro => 1e-6,
            Kind::Giga => 1e3,
            _ => 0.1,
        };
        let tilt = if random.chance(0.3) { random.vector() * 4.0 } else { Vec3::zeros() };
        let structure = Structure { gravity: tilt - Vec3::z() * 9.81, ..Structure::default() };
        Self { kind: recipe.kind, random, pitch, structure }
    }

    /// A connected set of cells, grown from the origin upwards and sideways.
    fn grow(&mut self, count: usize) -> Vec<[i32; 3]> {
        let mut cells = vec![[0, 0, 0]];
        while cells.len() < count {
            let from = cells[self.random.below(cells.len())];
            // A slender one seldom leaves the first axis.
            let along = self.kind == Kind::Slender && self.random.chance(0.95);
            let step = DIRECTIONS[self.random.below(if along { 2 } else { 6 })];
            let cell = [from[0] + step[0], from[1] + step[1], from[2] + step[2]];
            if cell[2] >= 0 && !cells.contains(&cell) {
                cells.push(cell);
            }
        }
        cells
    }

    fn add_body(&mut self, cell: [i32; 3]) {
        let density = match self.kind {
            Kind::Masses => self.random.decade(0.5, 5e5),
            Kind::LogNormal => self.random.lognormal(500.0, 3.0),
            _ => self.random.decade(200.0, 1500.0),
        };
        let fixed = self.random.chance(if self.kind == Kind::Clamped { 0.4 } else { 0.04 });
        let weightless = self.random.chance(if self.kind == Kind::Clamped { 0.4 } else { 0.03 });
        let com = (direction(cell) + self.random.vector() * 0.2) * self.pitch;
        let mass = if weightless { 0.0 } else { density * self.pitch.powi(3) };
        self.structure.bodies.push(Body { mass, com, fixed });
    }

    /// A few connectors whose strengths are of the order of what has to be held.
    fn add_connectors(&mut self) {
        let weight = self.structure.bodies.iter().map(|b| b.mass).sum::<f64>() * 9.81;
        let weight = if weight > 0.0 { weight } else { 1.0 };
        for index in 0..1 + self.random.below(4) {
            let factor = match self.kind {
                Kind::Strengths => self.random.decade(1e-3, 1e3),
                Kind::LogNormal => self.random.lognormal(1.0, 3.0),
                _ => self.random.decade(1.0 / 3.0, 3.0),
            };
            let strength = weight * factor * 4.0;
            let choice = if self.kind == Kind::Hinged && self.random.chance(0.7) { 1 } else { self.random.below(3) };
            let model = match choice {
                0 => self.cone(),
                1 => self.latch(strength),
                _ => self.face(),
            };
            self.structure.connectors.push(Connector { name: format!("c{index}"), strength, model });
        }
    }

    fn cone(&mut self) -> Model {
        let narrowest = if self.kind == Kind::Radii { 1e-6 } else { 0.1 };
        let pitch = self.pitch;
        let mut radius = || self.random.decade(narrowest, 0.5) * pitch;
        let radius = [radius(), radius(), radius()];
        Model::Cone { friction: [self.random.between(0.2, 1.0), self.random.between(0.2, 1.0)], radius }
    }

    fn latch(&mut self, strength: f64) -> Model {
        let (zero, none) = if self.kind == Kind::Hinged { (0.15, 0.3) } else { (0.0, 0.0) };
        let mut limit = |size: f64| {
            if self.random.chance(zero) {
                0.0
            } else if self.random.chance(none) {
                f64::INFINITY
            } else {
                size * self.random.decade(0.3, 3.0)
            }
        };
        let (force, torque) = (strength, strength * self.pitch * 0.3);
        let (shear, tension) = ([limit(force), limit(force)], limit(force));
        let (bending, torsion) = ([limit(torque), limit(torque)], limit(torque));
        let compression = if self.random.chance(0.6) { f64::INFINITY } else { force * self.random.decade(0.5, 5.0) };
        Model::Box { shear, tension, compression, bending, torsion }
    }

    fn face(&mut self) -> Model {
        let half = self.pitch * self.random.between(0.2, 0.5);
        let count = 3 + self.random.below(4);
        let phase = self.random.between(0.0, 6.0);
        let points = (0..count).map(|k| {
            let angle = phase + std::f64::consts::TAU * k as f64 / count as f64;
            [half * angle.cos(), half * angle.sin()]
        });
        let points = points.collect();
        Model::Patch { friction: self.friction(), points }
    }

    fn friction(&mut self) -> f64 {
        if self.kind == Kind::Friction && self.random.chance(0.5) {
            [0.0, 1e-6, 1e3][self.random.below(3)]
        } else {
            self.random.between(0.2, 1.0)
        }
    }

    /// Joins neighbours: a spanning tree of connections, with the odd contact
    /// instead, and some of the other pairs.
    fn join(&mut self, cells: &[[i32; 3]]) {
        let extra = if self.kind == Kind::Redundant { 1.0 } else { 0.5 };
        let joined = if self.kind == Kind::Standing { 0.6 } else { 0.9 };
        for j in 1..cells.len() {
            let mut first = true;
            for i in 0..j {
                let step: [i32; 3] = std::array::from_fn(|k| cells[j][k] - cells[i][k]);
                if !DIRECTIONS.contains(&step) {
                    continue;
                }
                let (a, b) = (Anchor::Body(i), Anchor::Body(j));
                let centre = (direction(cells[i]) + direction(step) * 0.5) * self.pitch;
                if self.random.chance(if first { joined } else { extra }) {
                    self.connect(a, b, centre, direction(step));
                    if self.kind == Kind::Redundant && self.random.chance(0.3) {
                        self.connect(a, b, centre, direction(step));
                    }
                } else if first || self.random.chance(0.5) {
                    self.touch(j, a, centre, direction(step));
                }
                first = false;
            }
        }
    }

    /// Joins `a` to `b`, which lies in direction `normal`, either way round.
    fn connect(&mut self, a: Anchor, b: Anchor, centre: Vec3, normal: Vec3) {
        let (parent, child, z) = if self.random.chance(0.5) { (a, b, normal) } else { (b, a, -normal) };
        let axes = Rotation::rotation_between(&Vec3::z(), &z)
            .unwrap_or_else(|| Rotation::from_scaled_axis(Vec3::x() * std::f64::consts::PI));
        let spin = Rotation::from_scaled_axis(Vec3::z() * self.random.between(0.0, 6.0));
        let origin = centre + self.random.vector() * (0.05 * self.pitch);
        let connector = self.random.below(self.structure.connectors.len());
        let frame = Pose::from_parts(origin.into(), axes * spin);
        self.structure.connections.push(Connection { parent, child, connector, frame });
    }

    /// The corners of a face of `body`, whose normal points into it.
    fn touch(&mut self, body: usize, against: Anchor, centre: Vec3, normal: Vec3) {
        let side = Vec3::new(normal.y, normal.z, normal.x);
        let up = normal.cross(&side);
        let friction = self.friction();
        let flat = if self.kind == Kind::Collinear { 1e-6 } else { 1.0 };
        let corners = [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]];
        for [x, y] in corners.iter().take(if self.kind == Kind::Collinear { 3 } else { 4 }) {
            let position = centre + (side * *x + up * (*y * flat)) * self.pitch;
            self.structure.contacts.push(Contact { body, against, position, normal, friction });
        }
    }

    /// Stands the lowest cells on the ground, and holds some cells to the world.
    fn support(&mut self, cells: &[[i32; 3]]) {
        let hung = match self.kind {
            Kind::Collinear | Kind::Standing => 0.0,
            Kind::Clamped => 0.3,
            _ => 0.15,
        };
        let standing = self.random.chance(0.7);
        let free = matches!(self.kind, Kind::Collinear | Kind::Standing | Kind::Uneven);
        for (i, cell) in cells.iter().enumerate() {
            let centre = direction(*cell) * self.pitch;
            let below = centre - Vec3::z() * (0.5 * self.pitch);
            if cell[2] == 0 && (standing || free) {
                let slope = if self.kind == Kind::Uneven { self.random.vector() * 0.4 } else { Vec3::zeros() };
                self.touch(i, Anchor::World, below, (Vec3::z() + slope).normalize());
            } else if self.random.chance(hung) || (i == 0 && !standing) {
                self.connect(Anchor::World, Anchor::Body(i), below, Vec3::z());
            }
        }
    }

    fn load(&mut self) {
        let weight = self.structure.bodies.iter().map(|b| b.mass).fold(0.0, f64::max) * 9.81;
        for body in 0..self.structure.bodies.len() {
            if self.random.chance(if self.kind == Kind::Loaded { 0.7 } else { 0.1 }) {
                let force = self.random.vector() * weight;
                let torque = self.random.vector() * (0.3 * weight * self.pitch);
                let reach = if self.kind == Kind::Loaded { 5.0 } else { 0.5 };
                let arm = self.random.vector() * (reach * self.pitch);
                let at = self.random.chance(0.5).then(|| self.structure.bodies[body].com + arm);
                self.structure.loads.push(Load { body, force, torque, at });
            }
        }
    }
}
