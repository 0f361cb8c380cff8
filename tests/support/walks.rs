//! Walks through neighbouring states: each differs from the one before by one
//! connection, by where a loose module hangs, or by a load.

use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Contact, Load, Model, Structure};

use crate::random::Random;
use crate::scenes;

/// A structure whose connections come and go.
pub struct Walk {
    pub name: &'static str,
    /// The state now.
    pub structure: Structure,
    /// Connections that were taken away and may come back.
    away: Vec<Connection>,
    /// Connections that stay: those of the loose modules.
    loose: Vec<Loose>,
    random: Random,
}

/// A body that hangs from another one by a connection of its own.
struct Loose {
    body: usize,
    /// Where it may hang: host and connection point.
    places: Vec<(usize, Vec3, Vec3)>,
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    Removed,
    Added,
    Moved,
    Shifted,
}

impl Walk {
    fn new(name: &'static str, structure: Structure, seed: u64) -> Self {
        Self { name, structure, away: Vec::new(), loose: Vec::new(), random: Random::new(seed) }
    }

    /// Hangs a loose module of `mass` that reaches `reach` from its host's
    /// connection point, at any of `hosts` bodies.
    fn with_loose(mut self, mass: f64, half: f64, reach: f64, hosts: usize) -> Self {
        let mut places = Vec::new();
        for host in 0..hosts {
            let com = self.structure.bodies[host].com;
            for axis in 0..3 {
                for sign in [1.0, -1.0] {
                    let along = Vec3::ith(axis, sign);
                    let at = com + along * half;
                    let taken =
                        self.structure.connections.iter().any(|c| (c.frame.translation.vector - at).norm() < 1e-6)
                            || self
                                .structure
                                .contacts
                                .iter()
                                .any(|c| (c.position - com - along * half).norm() < half * 0.9);
                    if !taken {
                        places.push((host, at, along));
                    }
                }
            }
        }
        let body = self.structure.bodies.len();
        self.structure.bodies.push(Body { mass, com: Vec3::zeros(), fixed: false });
        self.structure.connections.push(Connection {
            parent: Anchor::World,
            child: Anchor::Body(body),
            connector: 0,
            frame: Pose::identity(),
        });
        self.loose.push(Loose { body, places });
        self.hang(0, 0, reach);
        self
    }

    fn hang(&mut self, loose: usize, place: usize, reach: f64) {
        let Loose { body, places } = &self.loose[loose];
        let (host, at, along) = places[place];
        self.structure.bodies[*body].com = at + along * reach;
        let child = Anchor::Body(*body);
        let connection = self.structure.connections.iter_mut().find(|c| c.child == child).expect("it hangs");
        connection.parent = Anchor::Body(host);
        let half_turn = Rotation::from_axis_angle(&nalgebra::Vector3::x_axis(), std::f64::consts::PI);
        let rotation = Rotation::rotation_between(&Vec3::z(), &along).unwrap_or(half_turn);
        connection.frame = Pose::from_parts(at.into(), rotation);
    }

    /// Scales all strengths.
    pub fn strengthen(&mut self, factor: f64) {
        for connector in &mut self.structure.connectors {
            connector.strength *= factor;
            if let Model::Box { shear, tension, compression, bending, torsion } = &mut connector.model {
                for limit in shear.iter_mut().chain([tension, compression]).chain(bending).chain([torsion]) {
                    *limit *= factor;
                }
            }
        }
    }

    /// A neighbour of the present state, which stays as it is.
    pub fn neighbour(&mut self) -> (Step, Neighbour) {
        let loose: Vec<Anchor> = self.loose.iter().map(|loose| Anchor::Body(loose.body)).collect();
        let mut structure = self.structure.clone();
        let mut away = self.away.clone();
        let kind = self.random.between(0.0, 1.0);
        let step = if kind < 0.2 && !loose.is_empty() {
            let pick = self.random.below(self.loose.len());
            let place = self.random.below(self.loose[pick].places.len());
            let before = self.structure.clone();
            let body = self.loose[pick].body;
            let connection = before.connections.iter().find(|c| c.child == Anchor::Body(body)).expect("it hangs");
            let reach = (before.bodies[body].com - connection.frame.translation.vector).norm();
            self.hang(pick, place, reach);
            structure = std::mem::replace(&mut self.structure, before);
            Step::Moved
        } else if kind < 0.3 {
            let body = self.random.below(structure.bodies.len());
            let typical = structure.bodies[body].mass * 9.81;
            let load = Load { body, force: self.random.vector() * (0.3 * typical), torque: Vec3::zeros(), at: None };
            structure.loads = vec![load];
            Step::Shifted
        } else if kind < 0.3 + 0.7 * away.len() as f64 / 6.0 {
            let back = away.swap_remove(self.random.below(away.len()));
            // In among the others, not at the end.
            let place = self.random.below(structure.connections.len() + 1);
            structure.connections.insert(place, back);
            Step::Added
        } else {
            let staying = |c: &Connection| loose.contains(&c.child);
            let mut pick = self.random.below(structure.connections.len());
            while staying(&structure.connections[pick]) {
                pick = self.random.below(structure.connections.len());
            }
            away.push(structure.connections.remove(pick));
            Step::Removed
        };
        (step, Neighbour { structure, away })
    }

    /// Makes a neighbour the present state.
    pub fn go(&mut self, to: Neighbour) {
        self.structure = to.structure;
        self.away = to.away;
    }
}

/// A state that the walk may go to.
pub struct Neighbour {
    pub structure: Structure,
    away: Vec<Connection>,
}

/// Five trusses.
pub fn trusses() -> Vec<Walk> {
    let standing = |name, size: [usize; 3], seed| {
        let nodes = size.iter().product();
        Walk::new(name, scenes::truss(size), seed)
            .with_loose(0.15, 0.06, 0.0435, nodes)
            .with_loose(0.15, 0.06, 0.0435, nodes)
    };
    let clamped = |name, size: [usize; 3], seed| {
        let nodes: usize = size.iter().product();
        Walk::new(name, cantilever(size), seed).with_loose(0.15, 0.06, 0.0435, nodes)
    };
    vec![
        standing("standing 2x2x2", [2, 2, 2], 1),
        standing("standing 3x2x2", [3, 2, 2], 2),
        standing("standing 3x3x2", [3, 3, 2], 3),
        clamped("cantilever 4x2x2", [4, 2, 2], 4),
        clamped("cantilever 8x2x2", [8, 2, 2], 5),
    ]
}

/// A truss whose first nodes are held by the world from the left.
fn cantilever(size: [usize; 3]) -> Structure {
    let mut structure = scenes::truss(size);
    structure.contacts.clear();
    for node in (0..size.iter().product()).filter(|node| node % size[0] == 0) {
        let at = structure.bodies[node].com - Vec3::x() * 0.06;
        let turn = Rotation::rotation_between(&Vec3::z(), &Vec3::x()).expect("not opposite");
        structure.connections.push(Connection {
            parent: Anchor::World,
            child: Anchor::Body(node),
            connector: 0,
            frame: Pose::from_parts(at.into(), turn),
        });
    }
    structure
}

const EDGE: f64 = 0.1;

/// Five structures of cubes.
pub fn cubes() -> Vec<Walk> {
    let half = EDGE / 2.0;
    let patch =
        Model::Patch { friction: 0.4, points: vec![[half, half], [-half, half], [-half, -half], [half, -half]] };
    let cone = Model::Cone { friction: [0.6, 0.6], radius: [0.04, 0.04, 0.03] };
    let latch = Model::Box {
        shear: [100.0, 100.0],
        tension: 100.0,
        compression: f64::INFINITY,
        bending: [4.0, 4.0],
        torsion: 4.0,
    };
    let cells = |size: [i32; 3]| {
        (0..size[2]).flat_map(move |z| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y, z])))
    };
    let left = |cell: &[i32; 3]| cell[0] == 0;
    let bridge: Vec<[i32; 3]> = cells([8, 1, 3]).filter(|c| c[2] == 2 || c[0] < 2 || c[0] > 5).collect();
    let gallows: Vec<[i32; 3]> = cells([5, 2, 5]).filter(|c| c[0] < 2 || c[2] > 3).collect();
    let walk = |name, cells: Vec<[i32; 3]>, model: &Model, support, seed| {
        let hosts = cells.len();
        Walk::new(name, blocks(&cells, model, support), seed).with_loose(0.6, half, half, hosts)
    };
    vec![
        walk("wall 4x4, faces", cells([4, 1, 4]).collect(), &patch, Support::Held(&left), 6),
        walk("plate 4x4, magnets", cells([4, 4, 1]).collect(), &cone, Support::Held(&left), 7),
        walk("bridge of 16, latches", bridge, &latch, Support::Floor, 8),
        walk("gallows of 26, magnets", gallows, &cone, Support::Floor, 9),
        walk("block 4x3x3, latches", cells([4, 3, 3]).collect(), &latch, Support::Held(&left), 10),
    ]
}

/// What holds cubes.
enum Support<'a> {
    /// The world, from the left, these cells.
    Held(&'a dyn Fn(&[i32; 3]) -> bool),
    /// A floor with friction under the lowest cells.
    Floor,
}

/// Cubes with every pair of faces that meet connected.
fn blocks(cells: &[[i32; 3]], model: &Model, support: Support<'_>) -> Structure {
    let connector = Connector { name: "face".to_owned(), strength: 120.0, model: model.clone() };
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let mut structure = Structure { gravity, connectors: vec![connector], ..Structure::default() };
    let position = |c: &[i32; 3]| Vec3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2])) * EDGE;
    let connect = |structure: &mut Structure, parent, child, at: Vec3, along: Vec3| {
        let rotation = Rotation::rotation_between(&Vec3::z(), &along).expect("not opposite");
        let frame = Pose::from_parts(at.into(), rotation);
        structure.connections.push(Connection { parent, child, connector: 0, frame });
    };
    for (i, cell) in cells.iter().enumerate() {
        let com = position(cell);
        structure.bodies.push(Body { mass: 0.6, com, fixed: false });
        for axis in 0..3 {
            let mut other = *cell;
            other[axis] -= 1;
            let along = Vec3::ith(axis, 1.0);
            if let Some(j) = cells.iter().position(|c| *c == other) {
                connect(&mut structure, Anchor::Body(j), Anchor::Body(i), com - along * (EDGE / 2.0), along);
            }
        }
        match support {
            Support::Held(which) => {
                if which(cell) {
                    let at = com - Vec3::x() * (EDGE / 2.0);
                    connect(&mut structure, Anchor::World, Anchor::Body(i), at, Vec3::x());
                }
            }
            Support::Floor => {
                if cell[2] == 0 {
                    for [x, y] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
                        let position = com + Vec3::new(x, y, -1.0) * (EDGE / 2.0);
                        structure.contacts.push(Contact {
                            body: i,
                            against: Anchor::World,
                            position,
                            normal: Vec3::z(),
                            friction: 0.5,
                        });
                    }
                }
            }
        }
    }
    structure
}
