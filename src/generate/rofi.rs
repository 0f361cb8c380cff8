//! Random trees of RoFI universal modules.
//!
//! A robot grows by a module whose dock, joint positions (of 90 degrees each) and angle of engagement are drawn, at a
//! dock drawn from those that are free; docks that happen to meet are connected too. On the ground the
//! first module is turned at random and stands as low as it can.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::robot::linkage::{Linkage, Module, Port, child_pose, mated};
use crate::robot::{Catalogue, Requirement, rofi};
use crate::spatial::{Pose, Vec3};

use super::draw::{Draw, Purpose};
use super::modular::may_stay;
use super::setting::{Setting, World};
use super::{Request, Tally};

/// Draws of one module before its robot is given up.
const PATIENCE: usize = 60;

/// Index of the universal module in the catalogue.
const UNIVERSAL: usize = 0;

/// Height in m of a shoe's axis above the ground that it stands on: its docks retracted.
const STANDING: f64 = 0.043;

/// One attempt at a robot. The first module of a goal is as that of its start if it is held.
pub fn grown(request: &Request, start: Option<&Linkage>, draw: &mut Draw, tally: &mut Tally) -> Option<Linkage> {
    let mut shape = empty(request);
    let first = match start {
        Some(start) if request.held => start.modules[0].clone(),
        _ => first(request, &shape, draw),
    };
    shape.modules.push(first);
    // A robot that is not complete may yet lean on what is added to it.
    let margin = |count: usize| (request.held || count == request.modules).then_some(request.margin);
    if !may_stay(&mut shape, 1, margin(1), tally) {
        return None;
    }
    let mut patience = PATIENCE;
    while shape.modules.len() < request.modules {
        let count = shape.modules.len();
        let next = next(&shape, draw)?;
        shape.modules.push(next);
        if may_stay(&mut shape, 1, margin(count + 1), tally) {
            patience = PATIENCE;
            continue;
        }
        shape.modules.truncate(count);
        shape.connections = shape.touching();
        patience -= 1;
        if patience == 0 {
            return None;
        }
    }
    Some(shape)
}

fn empty(request: &Request) -> Linkage {
    let reach = (2 * request.modules).min(12) as i32;
    let mut draw = Draw::new(request.seed, Purpose::Surroundings);
    let world = World::draw(request.setting, rofi::CELL, -rofi::CELL / 2.0, reach, &mut draw);
    Linkage {
        catalogue: Arc::new(Catalogue::rofi()),
        gravity: world.gravity,
        environment: world.environment,
        modules: Vec::new(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    }
}

/// The first module: in the origin, or on the ground with its lower shoe in the middle of a tile.
fn first(request: &Request, shape: &Linkage, draw: &mut Draw) -> Module {
    let turn = draw.orientation().rotation();
    let kind = &shape.catalogue.module_types[UNIVERSAL];
    let joints = positions(draw);
    let mut pose = Pose::from_parts(Vec3::zeros().into(), turn);
    if !matches!(request.setting, Setting::Space | Setting::Mounted) {
        let other = pose * kind.body_poses(&joints)[3] * rofi::other_half();
        let lower = other.translation.z.min(0.0);
        // On a block whose height is drawn as well, where there are blocks: what is inside one is rejected.
        let level = if request.setting == Setting::Steps { draw.below(3) as f64 * rofi::CELL } else { 0.0 };
        pose.translation.z += STANDING - lower + level;
    }
    Module { id: "u1".into(), module_type: UNIVERSAL, pose, joints, fixed: request.held }
}

/// Joint positions in steps: alpha and beta in their range, gamma all around.
fn positions(draw: &mut Draw) -> Vec<i32> {
    let mut position = |count: usize, least: i32| draw.below(count) as i32 + least;
    vec![position(3, -1), position(3, -1), position(4, -1)]
}

/// One more module, at a free dock.
fn next(shape: &Linkage, draw: &mut Draw) -> Option<Module> {
    let kind = &shape.catalogue.module_types[UNIVERSAL];
    let all = (0..shape.modules.len()).flat_map(|module| (0..kind.ports.len()).map(move |port| Port { module, port }));
    let taken = |port: &Port| shape.connections.iter().any(|connection| connection.ports.contains(port));
    let free: Vec<Port> = all.filter(|port| !taken(port)).collect();
    if free.is_empty() {
        return None;
    }
    let at = shape.port_frame(*draw.choose(&free))?;
    let own = draw.below(kind.ports.len());
    let roll = draw.below(4) as f64 * FRAC_PI_2;
    let joints = positions(draw);
    let pose = child_pose(kind, own, &joints, &mated(&at, roll))?;
    let id = format!("u{}", shape.modules.len() + 1);
    Some(Module { id, module_type: UNIVERSAL, pose, joints, fixed: false })
}
