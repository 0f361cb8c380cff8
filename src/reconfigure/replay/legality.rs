//! Which actions are legal in a state, from their definitions, and where they lead.

use nalgebra::{Matrix3, Rotation3, Unit};

use crate::geometry::Motion;
use crate::reconfigure::action::Action;
use crate::reconfigure::assembly::Engagement;
use crate::robot::{Cell, Configuration, Face, FaceConnection, Module, Orientation, Placement, Port};
use crate::spatial::{Pose, Rotation, Vec3};

use super::failure::Fault;

/// A legal action: the state after it, and the way of its moving module.
#[derive(Clone, Debug)]
pub struct Transition {
    pub after: Configuration,
    pub path: Option<Path>,
}

/// The way of a moving module.
#[derive(Clone, Debug)]
pub struct Path {
    pub module: usize,
    pub motion: Motion,
    /// What holds the robot together on the way.
    pub engaged: Vec<Engagement>,
    /// Equal steps in which the way is checked.
    pub steps: u32,
}

/// Steps in which a slide is checked: every 1/32.
const SLIDE_STEPS: u32 = 32;

/// Steps in which 90 degrees of a pivot are checked: every 3 degrees.
const QUARTER_STEPS: u32 = 30;

/// Where an action leads from a state.
pub fn transition(before: &Configuration, action: &Action) -> Result<Transition, Fault> {
    let count = before.modules.len();
    let known = |modules: &[usize]| modules.iter().all(|&m| m < count).then_some(()).ok_or(Fault::UnknownModule);
    match action {
        Action::Attach(connection) => {
            known(&connection.modules())?;
            attach(before, *connection)
        }
        Action::Detach(connection) => {
            known(&connection.modules())?;
            detach(before, *connection)
        }
        Action::Slide { module, to } => {
            known(&[*module])?;
            slide(before, *module, *to)
        }
        Action::Pivot { module, support, to } => {
            known(&[*module, *support])?;
            pivot(before, *module, *support, *to)
        }
    }
}

fn attach(before: &Configuration, connection: FaceConnection) -> Result<Transition, Fault> {
    if before.connections.contains(&connection) {
        return Err(Fault::AlreadyEngaged);
    }
    if !before.touching_connections().contains(&connection) {
        return Err(Fault::FacesApart);
    }
    let mut after = before.clone();
    after.connections.push(connection);
    after.connections.sort_unstable();
    Ok(Transition { after, path: None })
}

fn detach(before: &Configuration, connection: FaceConnection) -> Result<Transition, Fault> {
    if !before.connections.contains(&connection) {
        return Err(Fault::NotEngaged);
    }
    let mut after = before.clone();
    after.connections.retain(|engaged| *engaged != connection);
    Ok(Transition { after, path: None })
}

fn slide(before: &Configuration, module: usize, to: Cell) -> Result<Transition, Fault> {
    let mover = free_module(before, module)?;
    if !before.module_type(module).cell().slide {
        return Err(Fault::Unable);
    }
    let from = mover.placement.cell;
    let travel = step(from, to).ok_or(Fault::NoSuchMotion)?;
    let sides = || Face::ALL.into_iter().filter(|side| side.axis() != travel.axis());
    let beside = |cell, side| beyond(before, cell, side);

    let own = own_connections(before, module);
    if own.iter().any(|(side, _)| side.axis() == travel.axis()) {
        return Err(Fault::NotReleased);
    }
    let coplanar = |side: &Face| beside(from, *side).is_some() && beside(to, *side).is_some();
    if !sides().any(|side| coplanar(&side)) {
        return Err(Fault::NoSupport);
    }
    if !sides().filter(coplanar).any(|side| own.iter().any(|(engaged, _)| *engaged == side)) {
        return Err(Fault::NotHeld);
    }

    let mut engaged = others(before, module);
    for cell in [from, to] {
        let held = sides().filter_map(|side| Some(face(module, side, beside(cell, side)?)));
        engaged.extend(held);
    }
    let by = (Placement::new(to).centre(1.0) - Placement::new(from).centre(1.0)) * before.pitch();
    let landing = sides().filter_map(|side| Some((side, beside(to, side)?))).collect::<Vec<_>>();
    let after = landed(before, module, to, mover.placement.orientation, &landing);
    let path = Path { module, motion: Motion::Translation { by }, engaged, steps: SLIDE_STEPS };
    Ok(Transition { after, path: Some(path) })
}

fn pivot(before: &Configuration, module: usize, support: usize, to: Cell) -> Result<Transition, Fault> {
    let mover = free_module(before, module)?;
    let types = [module, support].map(|m| before.modules[m].module_type);
    if !before.module_type(module).cell().pivot || before.catalogue.hinge(types[0], types[1]).is_none() {
        return Err(Fault::Unable);
    }
    let (from, base) = (mover.placement.cell, before.modules[support].placement.cell);
    let up = step(base, from).ok_or(Fault::NoSupport)?;
    let quarter = step(from, to).filter(|travel| travel.axis() != up.axis());
    let half = step(base, to).filter(|travel| travel.axis() != up.axis());
    let (travel, turns, landing_on) = match (quarter, half) {
        (Some(travel), _) => (travel, 1, beyond(before, base, travel).ok_or(Fault::NoSupport)?),
        (None, Some(travel)) => (travel, 2, support),
        (None, None) => return Err(Fault::NoSuchMotion),
    };
    match own_connections(before, module)[..] {
        [(side, other)] if side == up.opposite() && other == support => {}
        [] => return Err(Fault::NotHeld),
        _ => return Err(Fault::NotReleased),
    }

    let pitch = before.pitch();
    let edge = Placement::new(base).centre(pitch) + (up.normal() + travel.normal()) * (pitch / 2.0);
    let axis = Unit::new_normalize(up.normal().cross(&travel.normal()));
    let turn = Face::ALL.into_iter().find(|f| f.normal().dot(&axis) > 0.5).expect("an axis along a face normal");
    let orientation = (0..turns).fold(mover.placement.orientation, |o, _| o.turned(Orientation::quarter_turn(turn)));

    let mut engaged = others(before, module);
    // z along the edge, x along the world axis after it.
    let x = Vec3::ith((turn.axis() + 1) % 3, 1.0);
    let upright = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, axis.cross(&x), axis.into_inner()]));
    let frame = Pose::from_parts(edge.into(), Rotation::from_rotation_matrix(&upright));
    engaged.push(Engagement::Hinge { parent: support, child: module, frame });

    let landing = [(if turns == 1 { up.opposite() } else { travel.opposite() }, landing_on)];
    let after = landed(before, module, to, orientation, &landing);
    let angle = f64::from(turns) * std::f64::consts::FRAC_PI_2;
    let motion = Motion::Rotation { centre: edge, axis, angle };
    let path = Path { module, motion, engaged, steps: turns * QUARTER_STEPS };
    Ok(Transition { after, path: Some(path) })
}

fn free_module(before: &Configuration, module: usize) -> Result<&Module, Fault> {
    let mover = &before.modules[module];
    match mover.fixed {
        true => Err(Fault::FixedModule),
        false if before.require.stay.contains(&module) => Err(Fault::MustStay),
        false => Ok(mover),
    }
}

/// The face whose normal leads from one cell to the other, if they are neighbours.
fn step(from: Cell, to: Cell) -> Option<Face> {
    let apart = |i: usize| to[i].checked_sub(from[i]);
    Face::from_step([apart(0)?, apart(1)?, apart(2)?])
}

/// The module beyond a face of a cell.
fn beyond(state: &Configuration, cell: Cell, side: Face) -> Option<usize> {
    let beyond = crate::robot::neighbour(cell, side)?;
    state.modules.iter().position(|module| module.placement.cell == beyond)
}

/// A module's engaged connections: the world direction of its face, and the other module.
fn own_connections(state: &Configuration, module: usize) -> Vec<(Face, usize)> {
    let own = |connection: &FaceConnection| match connection.ports {
        [a, b] if a.module == module => Some((state.direction(a), b.module)),
        [a, b] if b.module == module => Some((state.direction(b), a.module)),
        _ => None,
    };
    state.connections.iter().filter_map(own).collect()
}

/// What holds all modules but one.
fn others(state: &Configuration, module: usize) -> Vec<Engagement> {
    let others = state.connections.iter().filter(|connection| !connection.modules().contains(&module));
    others.map(|connection| Engagement::face(state, connection)).collect()
}

/// A module's face on another's; the one of smaller index is the parent, as at rest.
fn face(module: usize, side: Face, other: usize) -> Engagement {
    if module < other {
        Engagement::Face { modules: [module, other], towards: side }
    } else {
        Engagement::Face { modules: [other, module], towards: side.opposite() }
    }
}

/// The state after a move, with the moved module connected on these sides only.
fn landed(
    before: &Configuration,
    module: usize,
    cell: Cell,
    orientation: Orientation,
    landing: &[(Face, usize)],
) -> Configuration {
    let mut after = before.clone();
    after.modules[module].placement = Placement { cell, orientation };
    after.connections.retain(|connection| !connection.modules().contains(&module));
    let port = |m: usize, towards: Face| Port { module: m, face: after.modules[m].face_towards(towards) };
    let landed: Vec<_> = landing
        .iter()
        .map(|&(side, other)| FaceConnection::new(port(module, side), port(other, side.opposite())))
        .collect();
    after.connections.extend(landed);
    after.connections.sort_unstable();
    after
}
