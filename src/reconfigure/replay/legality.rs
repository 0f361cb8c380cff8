//! Which actions are legal in a state, from their definitions, and where they lead.

use nalgebra::{Matrix3, Rotation3, Unit};

use crate::geometry::Motion;
use crate::reconfigure::action::Action;
use crate::reconfigure::assembly::Engagement;
use crate::robot::{
    self, Cell, Configuration, Face, FaceConnection, Module, Orientation, Placement, Port, Stencil, Turn,
};
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

/// Steps in which a translation by one cell is checked: every 1/32.
const CELL_STEPS: u32 = 32;

/// Steps in which 90 degrees of a rotation are checked: every 3 degrees.
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
        Action::Move { motion, module, support, to } => {
            known(&[*module])?;
            known(support.as_slice())?;
            let (stencil, mover) = stencil(before, usize::from(*motion), *module, *support, *to)?;
            match (stencil.motion, *support) {
                (robot::Motion::Rotation { support: side, towards, turn }, Some(support)) => {
                    turned(before, *module, mover, support, [side.opposite(), towards], turn)
                }
                _ => translated(before, &stencil, *module, mover, *to),
            }
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

/// The stencil, turned as it must be, that makes the motion from where the module is to a cell, with the support
/// that it turns about if it turns; and the module's placement.
fn stencil(
    before: &Configuration,
    motion: usize,
    module: usize,
    support: Option<usize>,
    to: Cell,
) -> Result<(Stencil, Placement), Fault> {
    let from = free_module(before, module)?.placement;
    let types = |support: usize| [module, support].map(|m| before.modules[m].module_type);
    let hinged = |support: usize| before.catalogue.hinge(types(support)[0], types(support)[1]).is_some();
    let kind = before.catalogue.motions.get(motion).ok_or(Fault::Unable)?;
    if !before.module_type(module).cell().motions.contains(&motion) || !support.is_none_or(hinged) {
        return Err(Fault::Unable);
    }
    let offset = |cell: Cell| -> Option<Cell> {
        let apart = |i: usize| cell[i].checked_sub(from.cell[i]);
        Some([apart(0)?, apart(1)?, apart(2)?])
    };
    let (by, base) = (offset(to), support.map(|support| offset(before.modules[support].placement.cell)));
    let is_it = |stencil: &Stencil| match stencil.motion {
        robot::Motion::Translation { by: leads } => base.is_none() && by == Some(leads),
        robot::Motion::Rotation { support, .. } => {
            base == Some(Some(support.step())) && by == Some(stencil.motion.by())
        }
    };
    // Turning leaves a length as it is.
    let length = |by: Cell| by.map(|c| i128::from(c).pow(2)).iter().sum::<i128>();
    let may_be = kind.stencils.iter().filter(|stencil| by.map(length) == Some(length(stencil.motion.by())));
    let leading: Vec<Stencil> = may_be.flat_map(Stencil::variants).filter(is_it).collect();
    if leading.is_empty() {
        return Err(Fault::NoSuchMotion);
    }
    let is_filled = |offset: &Cell| {
        let cell: Cell = std::array::from_fn(|i| from.cell[i] + offset[i]);
        before.modules.iter().any(|module| module.placement.cell == cell)
    };
    let mut supported = leading.into_iter().filter(|stencil| stencil.occupied.iter().all(is_filled)).peekable();
    supported.peek().ok_or(Fault::NoSupport)?;
    let mut roomy = supported.filter(|stencil| !stencil.free.iter().any(is_filled)).peekable();
    roomy.peek().ok_or(Fault::NotFree)?;
    let own = own_connections(before, module);
    let may_keep = |stencil: &Stencil, side: Face| match stencil.motion {
        robot::Motion::Translation { by } => by[side.axis()] == 0,
        robot::Motion::Rotation { support, .. } => side == support,
    };
    let mut released = roomy.filter(|stencil| own.iter().all(|&(side, _)| may_keep(stencil, side))).peekable();
    released.peek().ok_or(Fault::NotReleased)?;
    let mut held = released.filter(|stencil| own.iter().any(|(side, _)| stencil.occupied.contains(&side.step())));
    Ok((held.next().ok_or(Fault::NotHeld)?, from))
}

/// Straight on, held by whatever the module slides along.
fn translated(
    before: &Configuration,
    stencil: &Stencil,
    module: usize,
    from: Placement,
    to: Cell,
) -> Result<Transition, Fault> {
    let travel = stencil.motion.by();
    let sides = || Face::ALL.into_iter().filter(|side| travel[side.axis()] == 0);
    let beside = |cell, side| beyond(before, cell, side);

    let mut engaged = others(before, module);
    let [xs, ys, zs] = [0, 1, 2].map(|i| from.cell[i].min(to[i])..=from.cell[i].max(to[i]));
    for cell in xs.flat_map(|x| ys.clone().map(move |y| [x, y])) {
        for z in zs.clone() {
            let cell = [cell[0], cell[1], z];
            engaged.extend(sides().filter_map(|side| Some(face(module, side, beside(cell, side)?))));
        }
    }
    let by = (Placement::new(to).centre(1.0) - Placement::new(from.cell).centre(1.0)) * before.pitch();
    let landing = sides().filter_map(|side| Some((side, beside(to, side)?))).collect::<Vec<_>>();
    let after = landed(before, module, to, from.orientation, &landing);
    let steps = CELL_STEPS * stencil.motion.stages();
    let path = Path { module, motion: Motion::Translation { by }, engaged, steps };
    Ok(Transition { after, path: Some(path) })
}

/// About the edge of its support between the faces `up`, towards the module, and `travel`.
fn turned(
    before: &Configuration,
    module: usize,
    from: Placement,
    support: usize,
    [up, travel]: [Face; 2],
    turn: Turn,
) -> Result<Transition, Fault> {
    let base = before.modules[support].placement.cell;
    let (turns, to, landing_side) = match turn {
        Turn::Quarter => (1, crate::robot::neighbour(from.cell, travel), up.opposite()),
        Turn::Half => (2, crate::robot::neighbour(base, travel), travel.opposite()),
    };
    let to = to.ok_or(Fault::NoSuchMotion)?;
    let landing_on = beyond(before, to, landing_side).ok_or(Fault::NoSupport)?;

    let pitch = before.pitch();
    let edge = Placement::new(base).centre(pitch) + (up.normal() + travel.normal()) * (pitch / 2.0);
    let axis = Unit::new_normalize(up.normal().cross(&travel.normal()));
    let turn = Face::ALL.into_iter().find(|f| f.normal().dot(&axis) > 0.5).expect("an axis along a face normal");
    let orientation = (0..turns).fold(from.orientation, |o, _| o.turned(Orientation::quarter_turn(turn)));

    let mut engaged = others(before, module);
    // z along the edge, x along the world axis after it.
    let x = Vec3::ith((turn.axis() + 1) % 3, 1.0);
    let upright = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, axis.cross(&x), axis.into_inner()]));
    let frame = Pose::from_parts(edge.into(), Rotation::from_rotation_matrix(&upright));
    engaged.push(Engagement::Hinge { parent: support, child: module, frame });

    let after = landed(before, module, to, orientation, &[(landing_side, landing_on)]);
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
