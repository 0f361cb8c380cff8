//! Random structures of struts and nodes, all of them along the axes of a cubic grid whose edges are struts.
//!
//! A structure grows by a strut with a node at its far end, at a node and in a direction drawn from all that lead to an
//! empty place above the ground. Half of the modules are nodes, rounded up; the strut that an even number
//! leaves over joins two nodes or hangs on one.

use std::sync::Arc;

use crate::robot::linkage::{Linkage, Module};
use crate::robot::{Catalogue, Cell, Face, PortPlace, Requirement, neighbour};
use crate::spatial::{Pose, Rotation, Vec3};

use super::draw::{Draw, Purpose};
use super::modular::may_stay;
use super::setting::World;
use super::{Request, Tally};

/// The modules' indices in the catalogue.
const NODE: usize = 0;
const STRUT: usize = 1;

/// One attempt at a structure. That of a goal has its first node where the start's has it: above the same tile.
pub fn grown(request: &Request, draw: &mut Draw, tally: &mut Tally) -> Option<Linkage> {
    let grid = Grid::new(request);
    let nodes = request.modules.div_ceil(2);
    let mut shape = grid.empty();
    let mut filled: Vec<Cell> = vec![[0, 0, grid.world.level(0, 0)]];
    let mut joined: Vec<(Cell, Face)> = Vec::new();
    shape.modules.push(grid.node(filled[0], 1, request.held));
    if !may_stay(&mut shape, 1, Some(request.margin), tally) {
        return None;
    }
    while shape.modules.len() < request.modules {
        let is_last = filled.len() == nodes;
        let mut open = grid.open(&filled, &joined, is_last);
        loop {
            if open.is_empty() {
                return None;
            }
            let (from, face) = open.swap_remove(draw.below(open.len()));
            let turn = draw.orientation_towards(face).rotation();
            let count = shape.modules.len();
            let to = neighbour(from, face)?;
            shape.modules.push(grid.strut(from, face, turn, count + 1));
            if !is_last {
                shape.modules.push(grid.node(to, count + 2, false));
            }
            let added = shape.modules.len() - count;
            if may_stay(&mut shape, added as u64, Some(request.margin), tally) {
                joined.push(edge(from, face)?);
                filled.extend((!is_last).then_some(to));
                break;
            }
            shape.modules.truncate(count);
        }
    }
    shape.connections = shape.touching();
    Some(shape)
}

/// Where nodes and struts can be.
struct Grid {
    catalogue: Arc<Catalogue>,
    world: World,
    /// Distance in m of nodes that a strut joins.
    pitch: f64,
    /// Height in m of the centre of a node that lies on its tile, above that.
    radius: f64,
}

impl Grid {
    fn new(request: &Request) -> Self {
        let catalogue = Arc::new(Catalogue::freesn());
        let radius = catalogue.module_types[NODE].bodies[0].shape.ball_radius().expect("a node is a ball");
        let top = match &catalogue.module_types[STRUT].ports[1].place {
            PortPlace::Point { frame, .. } => frame.translation.z,
            PortPlace::Surface => 0.0,
        };
        let pitch = 2.0 * (top + radius);
        let reach = request.modules.div_ceil(2).min(8) as i32;
        let mut draw = Draw::new(request.seed, Purpose::Surroundings);
        let world = World::draw(request.setting, pitch, -pitch / 2.0, reach, &mut draw);
        Self { catalogue, world, pitch, radius }
    }

    fn empty(&self) -> Linkage {
        Linkage {
            catalogue: Arc::clone(&self.catalogue),
            gravity: self.world.gravity,
            environment: self.world.environment.clone(),
            modules: Vec::new(),
            connections: Vec::new(),
            loads: Vec::new(),
            require: Requirement::default(),
        }
    }

    /// Where a strut may be added, as a node and a direction, each place once: to an empty place or, where no further
    /// node is to be had, to another node as well.
    fn open(&self, filled: &[Cell], joined: &[(Cell, Face)], is_last: bool) -> Vec<(Cell, Face)> {
        let mut open: Vec<(Cell, Face)> = Vec::new();
        for &from in filled {
            for face in Face::ALL {
                let (Some(to), Some(edge)) = (neighbour(from, face), edge(from, face)) else { continue };
                let joins = filled.contains(&to);
                let within = to[0].abs().max(to[1].abs()) <= self.world.reach;
                let seen = joins && (face.step().iter().sum::<i32>() < 0);
                if within && !joined.contains(&edge) && (!joins || is_last) && !seen {
                    open.push((from, face));
                }
            }
        }
        open
    }

    fn centre(&self, site: Cell) -> Vec3 {
        Vec3::from(site.map(f64::from)) * self.pitch + Vec3::new(0.0, 0.0, self.radius)
    }

    fn node(&self, site: Cell, number: usize, fixed: bool) -> Module {
        let pose = Pose::from_parts(self.centre(site).into(), Rotation::identity());
        Module { id: format!("n{number}"), module_type: NODE, pose, joints: Vec::new(), fixed }
    }

    /// A strut on a node, turned so that it looks away from it.
    fn strut(&self, from: Cell, face: Face, turn: Rotation, number: usize) -> Module {
        let middle = self.centre(from) + face.normal() * (self.pitch / 2.0);
        let pose = Pose::from_parts(middle.into(), turn);
        Module { id: format!("s{number}"), module_type: STRUT, pose, joints: Vec::new(), fixed: false }
    }
}

/// The edge of the grid that leads from a site in a direction, whichever end it is named from.
fn edge(from: Cell, face: Face) -> Option<(Cell, Face)> {
    match face {
        Face::PosX | Face::PosY | Face::PosZ => Some((from, face)),
        Face::NegX | Face::NegY | Face::NegZ => Some((neighbour(from, face)?, face.opposite())),
    }
}
