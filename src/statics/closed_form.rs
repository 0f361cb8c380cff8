//! Blocks of one link: what crosses a bridge follows from balance alone.

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::Bracket;
use super::blocks::{Block, Link, Vertex};
use super::demand::{WrenchError, demand};
use super::frame::LinkFrame;
use super::loads::BodyLoad;
use super::structure::Structure;
use super::tolerances::DATA;

/// What was found out about a bridge.
pub(super) struct Bridge {
    /// Utilisation of its link, infinite when no strength suffices.
    pub utilisation: Bracket,
    /// Wrench of its link, in the link's frame.
    pub wrench: Wrench,
    /// Force of a contact on its body, in W.
    pub force: Vec3,
    failing: Twist,
    frame: LinkFrame,
}

impl Bridge {
    /// The motion of the body that hangs there in which the link gives way, that
    /// proves the lower bound.
    pub(super) fn mechanism(&self, structure: &Structure, block: &Block) -> Twist {
        let frame = &self.frame;
        let com = structure.bodies[block.bodies[0]].com;
        let at_origin = Twist::new(frame.axes * self.failing.linear, frame.axes * self.failing.angular);
        let here = at_origin.moved(&(com - frame.origin));
        let sign = sign(frame, block);
        Twist::new(here.linear * sign, here.angular * sign)
    }
}

/// Sign of the link's wrench on the block's body.
fn sign(frame: &LinkFrame, block: &Block) -> f64 {
    if frame.plus == Vertex::Body(block.bodies[0]) { 1.0 } else { -1.0 }
}

/// Assesses a block that consists of one link and one body that needs balance.
pub(super) fn assess_bridge(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Bridge {
    let (body, link) = (block.bodies[0], block.links[0]);
    let frame = LinkFrame::new(structure, link);
    let load = loads[body].moved(&(structure.bodies[body].com - frame.origin));
    let turned = |v: &Vec3| frame.axes.tr_mul(v);
    // The link holds what the body carries: the wrench on the plus side.
    let wrench = Wrench::new(turned(&load.wrench.force), turned(&load.wrench.torque)) * -sign(&frame, block);
    match link {
        Link::Connection(i) => {
            let connector = &structure.connectors[structure.connections[i].connector];
            let error = load.error();
            let turned_size = |v: &Vec3| frame.axes.abs().tr_mul(v);
            let error = WrenchError { force: turned_size(&error.force), torque: turned_size(&error.torque) };
            let demanded = demand(connector, &wrench, &error);
            let utilisation = demanded.utilisation;
            Bridge { utilisation, wrench, force: Vec3::zeros(), failing: demanded.failing, frame }
        }
        Link::Contact(i) => {
            let friction = structure.contacts[i].friction;
            let (force_slip, torque_slip) = (DATA * load.force_size.norm(), DATA * load.torque_size.norm());
            let escape = escape(&wrench, friction, force_slip, torque_slip);
            let utilisation = Bracket::exact(if escape.is_some() { f64::INFINITY } else { 0.0 });
            let held = Wrench::new(wrench.force, Vec3::zeros());
            let force = frame.axes * held.force;
            Bridge { utilisation, wrench: held, force, failing: escape.unwrap_or(Twist::ZERO), frame }
        }
    }
}

/// A motion at a contact point, in its frame, that the contact does not resist
/// but against which `wrench` would be needed; `None` when the contact can
/// provide it.
fn escape(wrench: &Wrench, friction: f64, force_slip: f64, torque_slip: f64) -> Option<Twist> {
    if !(wrench.torque.norm() <= torque_slip) {
        return Some(Twist::new(Vec3::zeros(), -wrench.torque));
    }
    let Wrench { force: f, .. } = wrench;
    let shear = Vec3::new(f.x, f.y, 0.0);
    if !(shear.norm() <= friction * f.z.max(0.0) + force_slip) {
        let slide = -shear.normalize();
        let lift = if f.z < 0.0 { Vec3::z() * (friction + shear.norm()) } else { Vec3::z() * friction };
        return Some(Twist::new(slide + lift, Vec3::zeros()));
    }
    (!(f.z >= -force_slip)).then(|| Twist::new(Vec3::z(), Vec3::zeros()))
}
