//! A block's critical stable state as a second-order cone program in standard form.
//!
//! ```text
//! minimise t   subject to   A z = -L,   z in K
//! ```
//!
//! One wrench per connection, and it is itself the cone variable, shifted by the
//! preload: with every strength at its common bound `s_l = t S_l` a `cone`
//! connection has `(t S + f_z, f_x/mu_x, .., tau_z/rho_z)` in a Lorentz cone, a
//! `patch` has its points' forces in friction cones and `w = sum - t S e_z`, and
//! a limited component of a `box` has `t F + f >= 0` and `t F - f >= 0`. Rows
//! are six balances per body, and one per doubly limited box component that ties
//! its two slacks. The dual variable of a body's balance is its twist in the
//! collapse mechanism.
//!
//! Rows and columns are scaled to forces and levers of the bodies and links they
//! belong to (see `scales`).

use crate::spatial::{Twist, Vec3, Wrench};

use super::blocks::{Block, Link, Vertex};
use super::connector::Model;
use super::frame::LinkFrame;
use super::loads::BodyLoad;
use super::scales::Scales;
use super::structure::Structure;

/// The cone that a group of consecutive variables lies in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cone {
    /// No restriction.
    Free,
    /// Each variable is at least zero.
    NonNegative,
    /// A Lorentz cone, its head first.
    Lorentz,
}

/// A group of consecutive variables in one cone, all of one link.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub cone: Cone,
    /// First variable and number of variables.
    pub first: usize,
    pub len: usize,
    /// Index of the link in the block.
    pub link: usize,
    /// Force in N that a scaled variable of 1 stands for.
    pub scale: f64,
    /// For a slack that only ties a box component: the variable it belongs to.
    pub ties: Option<usize>,
}

/// A column of A: `(row, entry)`, and the wrench in the link's frame that a
/// variable of 1 N stands for.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub entries: Vec<(usize, f64)>,
    pub local: Wrench,
}

/// What is asked of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// The least common utilisation t.
    Utilisation,
    /// Whether the loads can be held with strength without bound: t becomes the
    /// share of the loads that is left unheld, 0 or 1, and every connection may
    /// have any preload.
    Support,
}

/// Smallest force scale of a body, relative to the largest.
const FLOOR: f64 = 1e-9;

/// The scaled program of one block.
pub(super) struct Program {
    pub purpose: Purpose,
    pub groups: Vec<Group>,
    pub columns: Vec<Column>,
    /// Scaled column of t.
    pub preload: Vec<(usize, f64)>,
    /// Wrench in each link's frame that t = 1 stands for (minus the preload).
    pub preload_local: Vec<Wrench>,
    /// Scaled load per row (right-hand side is its negative).
    pub load: Vec<f64>,
    /// Row factors: scaled row = factor times row in N or N m.
    pub row_factor: Vec<f64>,
    /// The utilisation that a scaled t of 1 stands for.
    pub t_scale: f64,
    pub scales: Scales,
    pub frames: Vec<LinkFrame>,
    /// Per link, the share of its strength that the program lets it use.
    shares: Vec<f64>,
}

impl Program {
    /// The program scaled to each body's own forces, however small.
    pub(super) fn new(structure: &Structure, block: &Block, loads: &[BodyLoad], purpose: Purpose) -> Self {
        Self::with_floor(structure, block, loads, purpose, FLOOR)
    }

    /// The program with no body's force scale below `floor` times the largest.
    pub(super) fn with_floor(
        structure: &Structure,
        block: &Block,
        loads: &[BodyLoad],
        purpose: Purpose,
        floor: f64,
    ) -> Self {
        let all = vec![1.0; block.links.len()];
        Self::build(structure, block, loads, purpose, floor, all)
    }

    /// The program in which each link may use only a share of its strength: what
    /// it proves possible is possible.
    pub(super) fn with_shares(structure: &Structure, block: &Block, loads: &[BodyLoad], shares: Vec<f64>) -> Self {
        Self::build(structure, block, loads, Purpose::Utilisation, FLOOR, shares)
    }

    fn build(
        structure: &Structure,
        block: &Block,
        loads: &[BodyLoad],
        purpose: Purpose,
        floor: f64,
        shares: Vec<f64>,
    ) -> Self {
        let frames: Vec<LinkFrame> = block.links.iter().map(|&link| LinkFrame::new(structure, link)).collect();
        let scales = Scales::new(structure, block, &frames, loads, floor);
        let mut row_factor = Vec::with_capacity(6 * block.bodies.len());
        let mut load = Vec::with_capacity(6 * block.bodies.len());
        for (i, &body) in block.bodies.iter().enumerate() {
            let (force, torque) = (1.0 / scales.force[i], 1.0 / (scales.force[i] * scales.lever[i]));
            row_factor.extend([force, force, force, torque, torque, torque]);
            let wrench = &loads[body].wrench;
            load.extend(wrench.force.iter().map(|f| f * force));
            load.extend(wrench.torque.iter().map(|m| m * torque));
        }
        let mut program = Self {
            purpose,
            groups: Vec::new(),
            columns: Vec::new(),
            preload: Vec::new(),
            preload_local: vec![Wrench::ZERO; block.links.len()],
            load,
            row_factor,
            t_scale: 1.0,
            scales,
            frames,
            shares,
        };
        match purpose {
            Purpose::Utilisation => program.t_scale = program.typical_utilisation(structure, block),
            Purpose::Support => {
                program.preload =
                    program.load.iter().map(|load| -load).enumerate().filter(|entry| entry.1 != 0.0).collect();
            }
        }
        for (index, &link) in block.links.iter().enumerate() {
            program.add_link(structure, block, index, link);
        }
        program
    }

    /// Per group, the head of its variables in a state without any wrench at the
    /// typical utilisation: the strength, scaled.
    pub(super) fn resting_heads(&self) -> Vec<f64> {
        let mut sharing = vec![0.0; self.frames.len()];
        for group in &self.groups {
            sharing[group.link] += f64::from(u8::from(group.cone == Cone::Lorentz));
        }
        let head = |group: &Group| {
            let (local, preload) = (&self.columns[group.first].local, &self.preload_local[group.link]);
            let strength = -(local.force.dot(&preload.force) + local.torque.dot(&preload.torque));
            let tied = group.ties.map_or(0.0, |slack| {
                let row = self.columns[group.first].entries[0].0;
                let width = self.preload.iter().find(|entry| entry.0 == row).map_or(0.0, |entry| -entry.1);
                let local = &self.columns[slack].local;
                width
                    + (local.force.dot(&preload.force) + local.torque.dot(&preload.torque)) * self.t_scale / group.scale
            });
            tied + strength * self.t_scale / (group.scale * f64::max(sharing[group.link], 1.0))
        };
        self.groups.iter().map(head).collect()
    }

    pub(super) fn rows(&self) -> usize {
        self.load.len()
    }

    /// The twist of every body, of its centre of mass in W, that scaled dual
    /// variables stand for, in units of 1 W of dissipation at t = 1.
    pub(super) fn twists(&self, v: &[f64]) -> Vec<Twist> {
        let bodies = 0..self.scales.force.len();
        let unscaled = |i: usize, k: usize| v[6 * i + k] * self.row_factor[6 * i + k] * self.t_scale;
        let part = |i: usize, from: usize| Vec3::from_fn(|k, _| unscaled(i, from + k));
        bodies.map(|i| Twist::new(part(i, 0), part(i, 3))).collect()
    }

    /// Largest of force over strength: about the utilisation to expect.
    fn typical_utilisation(&self, structure: &Structure, block: &Block) -> f64 {
        let ratios = block.links.iter().zip(&self.scales.link).filter_map(|(link, force)| match link {
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[*i].connector];
                Some(force * shear_leverage(&connector.model) / connector.strength)
            }
            Link::Contact(_) => None,
        });
        let largest = ratios.fold(0.0, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }

    fn add_link(&mut self, structure: &Structure, block: &Block, index: usize, link: Link) {
        let force = self.scales.link[index];
        match link {
            Link::Contact(i) => {
                self.add_friction_cone(structure, block, index, structure.contacts[i].friction, &Vec3::zeros(), force);
            }
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[i].connector];
                match &connector.model {
                    Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                        let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()];
                        let locals = [
                            Wrench::new(z, Vec3::zeros()),
                            Wrench::new(x * *a, Vec3::zeros()),
                            Wrench::new(y * *b, Vec3::zeros()),
                            Wrench::new(Vec3::zeros(), x * *c),
                            Wrench::new(Vec3::zeros(), y * *d),
                            Wrench::new(Vec3::zeros(), z * *e),
                        ];
                        self.add_group(structure, block, index, Cone::Lorentz, &locals, force);
                        self.add_preload(structure, block, index, -z * connector.strength);
                    }
                    Model::Patch { friction, points } => {
                        for p in points {
                            let point = Vec3::new(p[0], p[1], 0.0);
                            self.add_friction_cone(structure, block, index, *friction, &point, force);
                        }
                        self.add_preload(structure, block, index, -Vec3::z() * connector.strength);
                    }
                    Model::Box { shear, tension, compression, bending, torsion } => {
                        let limits = [
                            (shear[0], shear[0]),
                            (shear[1], shear[1]),
                            (*tension, *compression),
                            (bending[0], bending[0]),
                            (bending[1], bending[1]),
                            (*torsion, *torsion),
                        ];
                        self.add_box(structure, block, index, &limits);
                    }
                }
            }
        }
    }

    /// The force of one contact point at `point` in the link's frame.
    fn add_friction_cone(
        &mut self,
        structure: &Structure,
        block: &Block,
        link: usize,
        friction: f64,
        point: &Vec3,
        scale: f64,
    ) {
        let at = |direction: Vec3| Wrench::new(direction, point.cross(&direction));
        let locals = [at(Vec3::z()), at(Vec3::x() * friction), at(Vec3::y() * friction)];
        if friction > 0.0 {
            self.add_group(structure, block, link, Cone::Lorentz, &locals, scale);
        } else {
            self.add_group(structure, block, link, Cone::NonNegative, &locals[..1], scale);
        }
    }

    fn add_box(&mut self, structure: &Structure, block: &Block, link: usize, limits: &[(f64, f64); 6]) {
        let lever = self.lever_of(block, link);
        let mut preload = Wrench::ZERO;
        for (component, &(negative, positive)) in limits.iter().enumerate() {
            let axis = Vec3::ith(component % 3, 1.0);
            let (local, scale) = if component < 3 {
                (Wrench::new(axis, Vec3::zeros()), self.scales.link[link])
            } else {
                (Wrench::new(Vec3::zeros(), axis), self.scales.link[link] * lever)
            };
            match (negative.is_finite(), positive.is_finite()) {
                (false, false) => {
                    self.add_group(structure, block, link, Cone::Free, &[local], scale);
                }
                (true, false) => {
                    self.add_group(structure, block, link, Cone::NonNegative, &[local], scale);
                    preload += local * -negative;
                }
                (false, true) => {
                    self.add_group(structure, block, link, Cone::NonNegative, &[-local], scale);
                    preload += local * positive;
                }
                (true, true) if negative == 0.0 && positive == 0.0 => {}
                (true, true) => {
                    let slack = self.add_group(structure, block, link, Cone::NonNegative, &[local], scale);
                    preload += local * -negative;
                    self.tie(link, slack, scale, (negative + positive) * self.shares[link]);
                }
            }
        }
        self.add_preload_wrench(structure, block, link, preload);
    }

    /// Adds the row `p + q = t width` that ties a box component's two slacks.
    fn tie(&mut self, link: usize, slack: usize, scale: f64, width: f64) {
        let row = self.rows();
        self.load.push(0.0);
        self.row_factor.push(1.0 / scale);
        self.columns[slack].entries.push((row, 1.0));
        let first = self.columns.len();
        self.columns.push(Column { entries: vec![(row, 1.0)], local: Wrench::ZERO });
        self.groups.push(Group { cone: Cone::NonNegative, first, len: 1, link, scale, ties: Some(slack) });
        self.preload.push((row, -width / scale * self.t_scale));
    }

    /// Longest lever of a link's bodies.
    pub(super) fn lever_of(&self, block: &Block, link: usize) -> f64 {
        let frame = &self.frames[link];
        let levers =
            frame.sides().into_iter().filter_map(|(side, _)| local_body(block, side).map(|i| self.scales.lever[i]));
        levers.fold(0.0, f64::max)
    }

    /// Adds variables with the given local wrenches; returns the first one's index.
    fn add_group(
        &mut self,
        structure: &Structure,
        block: &Block,
        link: usize,
        cone: Cone,
        locals: &[Wrench],
        scale: f64,
    ) -> usize {
        let first = self.columns.len();
        for local in locals {
            let entries = self.entries(structure, block, link, local, scale);
            self.columns.push(Column { entries, local: *local });
        }
        self.groups.push(Group { cone, first, len: locals.len(), link, scale, ties: None });
        first
    }

    fn add_preload(&mut self, structure: &Structure, block: &Block, link: usize, force: Vec3) {
        self.add_preload_wrench(structure, block, link, Wrench::new(force, Vec3::zeros()));
    }

    fn add_preload_wrench(&mut self, structure: &Structure, block: &Block, link: usize, local: Wrench) {
        if local == Wrench::ZERO {
            return;
        }
        let local = local * self.shares[link];
        match self.purpose {
            Purpose::Utilisation => {
                let entries = self.entries(structure, block, link, &local, self.t_scale);
                self.preload.extend(entries);
                self.preload_local[link] = local;
            }
            Purpose::Support => {
                let unit = local * (1.0 / local.force.norm());
                self.add_group(structure, block, link, Cone::NonNegative, &[unit], self.scales.link[link]);
            }
        }
    }

    /// Scaled balance entries of a wrench in a link's frame.
    fn entries(
        &self,
        structure: &Structure,
        block: &Block,
        link: usize,
        local: &Wrench,
        scale: f64,
    ) -> Vec<(usize, f64)> {
        let frame = &self.frames[link];
        let mut entries = Vec::with_capacity(12);
        for (side, sign) in frame.sides() {
            if let Some(i) = local_body(block, side) {
                let wrench = frame.to_body(local, &structure.bodies[block.bodies[i]].com);
                for (k, value) in wrench.force.iter().chain(wrench.torque.iter()).enumerate() {
                    if *value != 0.0 {
                        let row = 6 * i + k;
                        entries.push((row, value * sign * scale * self.row_factor[row]));
                    }
                }
            }
        }
        entries
    }
}

/// Strength that a unit of shear demands, or of tension if that is more.
fn shear_leverage(model: &Model) -> f64 {
    match model {
        Model::Cone { friction, .. } => friction.iter().map(|mu| 1.0 / mu).fold(1.0, f64::max),
        Model::Patch { friction, .. } if *friction > 0.0 => (1.0 / friction).max(1.0),
        Model::Box { .. } | Model::Patch { .. } => 1.0,
    }
}

/// Index within the block of a vertex that needs balance there.
pub(super) fn local_body(block: &Block, vertex: Vertex) -> Option<usize> {
    match vertex {
        Vertex::Body(i) if vertex != block.root => block.bodies.binary_search(&i).ok(),
        _ => None,
    }
}
