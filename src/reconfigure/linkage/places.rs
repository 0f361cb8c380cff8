//! Places of modules by number: what is the same place up to the symmetries of a module type has one
//! number.
//!
//! Knows poses and joint positions of one module at a time; does not know what a robot is.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use crate::robot::ModuleType;
use crate::robot::linkage::{MEETING, Symmetry};
use crate::spatial::{Pose, Vec3};

use super::problem::Class;

/// A place: the class in the upper half, so that numbers sort by class.
pub type PlaceId = u64;

/// The class of a place.
pub fn class_of(place: PlaceId) -> usize {
    usize::try_from(place >> 32).expect("32 bits")
}

/// One module, described in one of the ways that its symmetries leave open.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Index into the classes of the problem.
    pub class: usize,
    /// Pose of the module frame.
    pub pose: Pose,
    /// Positions of its joints.
    pub joints: Arc<[i32]>,
    /// Poses of its bodies.
    pub bodies: Arc<[Pose]>,
}

impl Place {
    /// A module of a class and of this type at a pose.
    pub fn new(class: usize, module_type: &ModuleType, pose: Pose, joints: &[i32]) -> Self {
        let bodies = module_type.body_poses(joints).into_iter().map(|local| pose * local).collect();
        Self { class, pose, joints: joints.into(), bodies }
    }
}

/// The ways to describe a module whose joints are at some positions.
#[derive(Debug)]
pub struct Descriptions {
    /// The smallest joint positions of all descriptions.
    pub joints: Arc<[i32]>,
    /// The frames of the descriptions with these positions, in the module's frame.
    pub frames: Vec<Pose>,
    /// Poses of the bodies in the module frame with these positions.
    bodies: Vec<Pose>,
}

/// All places met so far.
#[derive(Debug)]
pub struct Places {
    symmetries: Vec<Vec<Symmetry>>,
    types: Vec<Arc<ModuleType>>,
    /// By class and joint positions.
    descriptions: Vec<HashMap<Arc<[i32]>, Arc<Descriptions>>>,
    entries: Vec<Vec<Arc<Place>>>,
    /// Places by class, joint positions and cell of a grid.
    near: HashMap<u64, Vec<u32>>,
    /// Distance up to which places are one, in m.
    tolerance: f64,
    /// Edge of the grid's cells in m.
    cell: f64,
}

impl Places {
    /// No places yet, of modules of these classes.
    pub fn new(classes: &[Class]) -> Self {
        let size = classes.iter().map(|class| class.kind.size()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        Self {
            symmetries: classes.iter().map(|class| class.symmetries.clone()).collect(),
            types: classes.iter().map(|class| Arc::clone(&class.kind)).collect(),
            descriptions: classes.iter().map(|_| HashMap::new()).collect(),
            entries: vec![Vec::new(); classes.len()],
            near: HashMap::new(),
            // Codes are rounded to a micro-degree, ports meet within [`MEETING`].
            tolerance: MEETING * size,
            cell: size / 64.0,
        }
    }

    /// The place with a number.
    pub fn place(&self, id: PlaceId) -> &Arc<Place> {
        &self.entries[class_of(id)][(id & u64::from(u32::MAX)) as usize]
    }

    /// The ways to describe a module of a class with these joint positions.
    pub fn descriptions(&mut self, class: usize, joints: &[i32]) -> Arc<Descriptions> {
        if let Some(known) = self.descriptions[class].get(joints) {
            return Arc::clone(known);
        }
        let kind = &self.types[class];
        let all = &self.symmetries[class];
        let least = all.iter().map(|s| s.positions(kind, joints)).min().expect("the identity");
        let is_least = |symmetry: &&Symmetry| symmetry.positions(kind, joints) == least;
        let frame = |symmetry: &Symmetry| symmetry.described(kind, &Pose::identity(), joints).0;
        let frames = all.iter().filter(is_least).map(frame).collect();
        let bodies = kind.body_poses(&least);
        let new = Arc::new(Descriptions { joints: least.into(), frames, bodies });
        self.descriptions[class].insert(joints.into(), Arc::clone(&new));
        new
    }

    /// The number of a module's place, new if it was never met.
    pub fn number(&mut self, class: usize, pose: &Pose, described: &Descriptions) -> PlaceId {
        for frame in &described.frames {
            if let Some(id) = self.find(class, &(pose * frame), described) {
                return id;
            }
        }
        let pose = pose * described.frames[0];
        let index = u32::try_from(self.entries[class].len()).expect("memory ends before 2^32 places");
        let bodies = described.bodies.iter().map(|local| pose * local).collect();
        self.entries[class].push(Arc::new(Place { class, pose, joints: Arc::clone(&described.joints), bodies }));
        let cell = pose.translation.vector.map(|x| self.cell_of(x));
        self.near.entry(key(class, &described.joints, &cell)).or_default().push(index);
        number(class, index)
    }

    fn find(&self, class: usize, pose: &Pose, described: &Descriptions) -> Option<PlaceId> {
        let p = &pose.translation.vector;
        let low = p.map(|x| self.cell_of(x - self.tolerance));
        let high = p.map(|x| self.cell_of(x + self.tolerance));
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    let cell = nalgebra::Vector3::new(x, y, z);
                    let here = self.near.get(&key(class, &described.joints, &cell)).into_iter().flatten();
                    for &index in here {
                        let known = &self.entries[class][index as usize];
                        if known.joints == described.joints && self.is_same(&known.pose, pose) {
                            return Some(number(class, index));
                        }
                    }
                }
            }
        }
        None
    }

    /// Off the lattices that robots make.
    fn cell_of(&self, coordinate: f64) -> i64 {
        (coordinate / self.cell + 0.381_966).floor() as i64
    }

    fn is_same(&self, a: &Pose, b: &Pose) -> bool {
        let apart: Vec3 = a.translation.vector - b.translation.vector;
        // |q . r| is the cosine of half the angle between them.
        let cosine = a.rotation.coords.dot(&b.rotation.coords).abs();
        apart.norm() <= self.tolerance && 1.0 - cosine <= MEETING * MEETING / 8.0
    }
}

fn number(class: usize, index: u32) -> PlaceId {
    ((class as u64) << 32) | u64::from(index)
}

fn key(class: usize, joints: &[i32], cell: &nalgebra::Vector3<i64>) -> u64 {
    let mut hasher = DefaultHasher::new();
    (class, joints, cell.x, cell.y, cell.z).hash(&mut hasher);
    hasher.finish()
}
