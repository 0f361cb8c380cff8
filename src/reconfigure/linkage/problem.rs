//! A start and a goal, prepared for search: classes of interchangeable modules, and what a displacement
//! of the whole robot changes.
//!
//! Knows no search and asks no oracle.

use std::sync::Arc;

use crate::reconfigure::refusal::{Impossible, Refusal, Rejection};
use crate::robot::linkage::{Directions, Goal, Linkage, MEETING, Module, Symmetry, is_square};
use crate::robot::{ModuleLoad, ModuleType};
use crate::spatial::{Pose, Vec3};

use super::arrangement::Frame;
use super::assembly::Held;

/// What makes modules interchangeable: those of one class can swap places without a difference to geometry, statics
/// or the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Index into the catalogue's module types.
    pub module_type: usize,
    /// The type itself.
    pub kind: Arc<ModuleType>,
    /// Whether its modules are held immovably.
    pub fixed: bool,
    /// Whether no action may move its modules or their joints.
    pub stays: bool,
    /// The loads on each of its modules; their module index is always 0.
    pub loads: Vec<ModuleLoad>,
    /// The one module of the class, where modules are labelled.
    pub label: Option<String>,
    /// The ways to describe its modules: of loaded ones those that leave the points of action where they are, of
    /// fixed ones only as they are.
    pub symmetries: Vec<Symmetry>,
    /// How far its ports and solids reach from the origin, in m, whatever its joints.
    pub reach: f64,
    /// For every joint, which bodies are beyond it.
    beyond: Vec<Vec<bool>>,
}

impl Class {
    /// Whether a body is on the child's side of a joint.
    pub fn is_beyond(&self, joint: usize, body: usize) -> bool {
        self.beyond[joint][body]
    }
}

/// A module by class, pose and joint positions.
pub type Described = (usize, Pose, Arc<[i32]>);

/// A reconfiguration problem.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The start, its connections sorted and its joint positions within one turn.
    pub start: Linkage,
    /// The goal, likewise.
    pub goal: Linkage,
    /// The classes of the modules.
    pub classes: Arc<[Class]>,
    /// The class of each module of the start.
    pub class_of: Vec<usize>,
    /// The class of each module of the goal.
    pub wanted: Vec<usize>,
    /// Up to which displacement states are the same.
    pub frame: Frame,
    /// The modules of the start, sorted by class: those that the modules of an arrangement stand for.
    pub slots: Vec<usize>,
}

impl Problem {
    /// Prepares a start and a goal.
    ///
    /// # Errors
    /// [`Rejection::Refused`] for data that no robot can have or a goal that cannot be compared with the start,
    /// [`Rejection::Impossible`] when the modules alone prove that the goal cannot be reached.
    pub fn new(start: &Linkage, goal: &Goal) -> Result<Self, Rejection<Held>> {
        super::refusal::check(start, goal)?;
        let frame = frame(start, goal)?;
        let (start, wanted_linkage) = (normal(start), normal(&goal.linkage));
        let (classes, class_of) = classes(&start, goal.matching.labelled, is_square(&[&start, &wanted_linkage]));
        let wanted = goal_classes(&start, &class_of, &classes, &wanted_linkage, goal.matching.labelled)?;
        let mut slots: Vec<usize> = (0..start.modules.len()).collect();
        slots.sort_by_key(|&module| class_of[module]);
        Ok(Self { start, goal: wanted_linkage, classes: classes.into(), class_of, wanted, frame, slots })
    }

    /// The modules of a linkage that has the start's modules.
    pub fn described(&self, linkage: &Linkage) -> Vec<Described> {
        described(linkage, &self.class_of)
    }

    /// The modules of the goal.
    pub fn wanted(&self) -> Vec<Described> {
        described(&self.goal, &self.wanted)
    }
}

fn described(linkage: &Linkage, class_of: &[usize]) -> Vec<Described> {
    let modules = linkage.modules.iter().zip(class_of);
    modules.map(|(module, &class)| (class, module.pose, module.joints.clone().into())).collect()
}

/// A linkage with its connections sorted and its joint positions within one turn.
fn normal(linkage: &Linkage) -> Linkage {
    let mut normal = linkage.clone();
    normal.connections.sort_unstable();
    for module in 0..normal.modules.len() {
        let kinds = &linkage.module_type(module).joints;
        for (position, kind) in normal.modules[module].joints.iter_mut().zip(kinds) {
            *position = kind.canonical(*position);
        }
    }
    normal
}

/// Up to which displacement states are the same.
fn frame(start: &Linkage, goal: &Goal) -> Result<Frame, Refusal> {
    let is_held = start.modules.iter().any(|module| module.fixed);
    let is_loaded = !start.loads.is_empty();
    let is_unrestricted = start.require.stay.is_empty() && start.require.keep_out.is_empty();
    let has_ground = start.environment.ground.is_some();
    let is_empty = start.environment.obstacles.is_empty() && !has_ground;
    if !goal.matching.free_frame {
        return Ok(Frame::World);
    }
    if is_empty && is_unrestricted && !is_held && !is_loaded && start.gravity == Vec3::zeros() {
        return Ok(Frame::Free);
    }
    let because = match () {
        () if is_held => "a module is fixed",
        () if !start.require.stay.is_empty() => "a module may not move",
        () if !start.require.keep_out.is_empty() => "there are forbidden regions",
        () if !start.environment.obstacles.is_empty() => "there are obstacles",
        () if start.gravity.x != 0.0 || start.gravity.y != 0.0 => "gravity is not vertical",
        () if is_loaded => "a module is loaded",
        () => return Ok(Frame::Ground),
    };
    Err(Refusal::NoFreeFrame { because })
}

/// The classes of the start's modules, in order of first appearance. `square` says that everything is turned by
/// quarters and stays so.
fn classes(start: &Linkage, labelled: bool, square: bool) -> (Vec<Class>, Vec<usize>) {
    let mut steps: Vec<f64> = Vec::new();
    for module in 0..start.modules.len() {
        steps.extend(start.module_type(module).roll_step_degrees.filter(|step| !steps.contains(step)));
    }
    let directions = if square { Directions::Axes } else { Directions::Steps(&steps) };
    let mut classes: Vec<Class> = Vec::new();
    let mut class_of = Vec::with_capacity(start.modules.len());
    for (index, module) in start.modules.iter().enumerate() {
        let own = start.loads.iter().filter(|load| load.module == index);
        let loads: Vec<ModuleLoad> = own.map(|load| ModuleLoad { module: 0, ..load.clone() }).collect();
        let label = labelled.then(|| module.id.clone());
        let stays = start.require.stay.contains(&index);
        let is_same = |class: &Class| {
            class.module_type == module.module_type
                && class.fixed == module.fixed
                && class.stays == stays
                && class.loads == loads
                && class.label == label
        };
        let position = classes.iter().position(is_same).unwrap_or_else(|| {
            let kind = start.module_type(index).clone();
            let mut symmetries = start.catalogue.symmetries(module.module_type, directions);
            if module.fixed || stays {
                symmetries.truncate(1);
            }
            let points = || loads.iter().map(|load| load.at.unwrap_or(kind.body().com));
            let tolerance = MEETING * kind.size();
            symmetries.retain(|symmetry| points().all(|point| symmetry.keeps_point(&point, tolerance)));
            let beyond = (0..kind.joints.len()).map(|joint| beyond(&kind, joint)).collect();
            let kind = Arc::new(kind);
            let module_type = module.module_type;
            let reach = reach(&kind);
            classes.push(Class {
                module_type,
                kind,
                fixed: module.fixed,
                stays,
                loads,
                label,
                symmetries,
                reach,
                beyond,
            });
            classes.len() - 1
        });
        class_of.push(position);
    }
    (classes, class_of)
}

/// How far a module reaches from its origin, in m, whatever its joints: each turns what is beyond it about a point of
/// its axis, twice as far at most.
fn reach(kind: &ModuleType) -> f64 {
    let balls = kind.bodies.iter().filter_map(|body| body.shape.ball_radius());
    let ball = balls.fold(0.0, f64::max);
    let joints: f64 = kind.joints.iter().map(|joint| 2.0 * joint.origin.norm()).sum();
    (kind.size() + ball + joints) * (1.0 + 1e-3)
}

/// The bodies on the child's side of a joint.
fn beyond(kind: &ModuleType, joint: usize) -> Vec<bool> {
    let mut beyond = vec![false; kind.bodies.len()];
    beyond[kind.joints[joint].child] = true;
    for _ in 1..kind.bodies.len() {
        for (_, other) in kind.joints.iter().enumerate().filter(|(index, _)| *index != joint) {
            if beyond[other.parent] || beyond[other.child] {
                (beyond[other.parent], beyond[other.child]) = (true, true);
            }
        }
    }
    beyond
}

/// The class of each of the goal's modules. A module is fixed or loaded if its namesake in the start is.
fn goal_classes(
    start: &Linkage,
    class_of: &[usize],
    classes: &[Class],
    goal: &Linkage,
    labelled: bool,
) -> Result<Vec<usize>, Rejection<Held>> {
    for (index, module) in start.modules.iter().enumerate() {
        let is_placed = || goal.modules.iter().any(|other| other.id == module.id);
        if !classes[class_of[index]].loads.is_empty() && !is_placed() {
            return Err(Refusal::LoadedModuleMissing { module: module.id.clone() }.into());
        }
    }
    let mut wanted = Vec::with_capacity(goal.modules.len());
    for module in &goal.modules {
        let namesake = start.modules.iter().position(|other| other.id == module.id);
        let namesake = namesake.filter(|&index| start.modules[index].module_type == module.module_type);
        let is_own = |&index: &usize| {
            let class = &classes[class_of[index]];
            labelled || class.fixed || class.stays || !class.loads.is_empty()
        };
        let plain = |class: &Class| {
            class.module_type == module.module_type
                && !class.fixed
                && !class.stays
                && class.loads.is_empty()
                && class.label.is_none()
        };
        let class = match namesake.filter(is_own) {
            Some(index) => Some(class_of[index]),
            None => classes.iter().position(plain),
        };
        wanted.push(class.ok_or_else(|| differ(start, goal, module.module_type))?);
    }
    for (index, module) in start.modules.iter().enumerate() {
        let count = |classes: &[usize]| classes.iter().filter(|&&class| class == class_of[index]).count();
        if count(class_of) != count(&wanted) {
            if module.fixed || start.require.stay.contains(&index) {
                return Err(Impossible::FixedModule { module: module.id.clone() }.into());
            }
            return Err(differ(start, goal, module.module_type));
        }
    }
    let held = start.modules.iter().enumerate();
    let held = held.filter(|(index, module)| module.fixed || start.require.stay.contains(index));
    for (index, module) in held {
        let there = goal.modules.iter().find(|other| other.id == module.id);
        let size = classes.iter().map(|class| class.kind.size()).fold(0.0, f64::max);
        let keeps_joints = |there: &Module| !start.require.stay.contains(&index) || there.joints == module.joints;
        let stays = there.is_some_and(|there| is_near(&module.pose, &there.pose, size) && keeps_joints(there));
        if !stays {
            return Err(Impossible::FixedModule { module: module.id.clone() }.into());
        }
    }
    Ok(wanted)
}

fn is_near(a: &Pose, b: &Pose, size: f64) -> bool {
    let apart = a.translation.vector - b.translation.vector;
    apart.norm() <= crate::robot::linkage::MEETING * size
        && a.rotation.angle_to(&b.rotation) <= crate::robot::linkage::MEETING
}

/// That start and goal differ in how many modules of a type they have.
fn differ(start: &Linkage, goal: &Linkage, module_type: usize) -> Rejection<Held> {
    let count = |c: &Linkage| c.modules.iter().filter(|m| m.module_type == module_type).count();
    Impossible::ModulesDiffer {
        module_type: start.catalogue.module_types[module_type].name.clone(),
        start: count(start),
        goal: count(goal),
    }
    .into()
}
