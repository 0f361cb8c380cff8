//! Blocks of one link: what crosses a bridge follows from balance alone.

use nalgebra::Matrix3;

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::Bracket;
use super::blocks::Link;
use super::demand::{WrenchError, demand};
use super::frame::placed;
use super::loads::BodyLoad;
use super::structure::{Anchor, Structure};
use super::tolerances::DATA;

/// What was found out about a bridge.
pub(super) struct Bridge {
    pub link: Link,
    /// The body that hangs there.
    pub body: usize,
    /// Utilisation of its link, infinite when no strength suffices.
    pub utilisation: Bracket,
    /// Wrench of its link, in the link's frame.
    pub wrench: Wrench,
    /// Force of a contact on its body, in W.
    pub force: Vec3,
    failing: Twist,
    /// Of the link's frame in W.
    origin: Vec3,
    axes: Matrix3<f64>,
    /// Sign of the link's wrench on the body.
    sign: f64,
}

impl Bridge {
    /// The motion of the body that hangs there in which the link gives way, that
    /// proves the lower bound.
    pub(super) fn mechanism(&self, structure: &Structure) -> Twist {
        let com = structure.bodies[self.body].com;
        let at_origin = Twist::new(self.axes * self.failing.linear, self.axes * self.failing.angular);
        let here = at_origin.moved(&(com - self.origin));
        Twist::new(here.linear * self.sign, here.angular * self.sign)
    }
}

/// Assesses a block that consists of `link` and `body`, which needs balance. Looks at nothing
/// else of the structure: in a large one that would mean waiting for memory.
pub(super) fn assess_bridge(structure: &Structure, link: Link, body: usize, loads: &[BodyLoad]) -> Bridge {
    let (origin, axes) = placed(structure, link);
    let gets_it = match link {
        Link::Connection(i) => structure.connections[i].child == Anchor::Body(body),
        Link::Contact(i) => structure.contacts[i].body == body,
    };
    let sign = if gets_it { 1.0 } else { -1.0 };
    let load = loads[body].moved(&(structure.bodies[body].com - origin));
    let turned = |v: &Vec3| axes.tr_mul(v);
    // The link holds what the body carries: the wrench on the plus side.
    let wrench = Wrench::new(turned(&load.wrench.force), turned(&load.wrench.torque)) * -sign;
    match link {
        Link::Connection(i) => {
            let connector = &structure.connectors[structure.connections[i].connector];
            let error = load.error();
            let turned_size = |v: &Vec3| axes.abs().tr_mul(v);
            let error = WrenchError { force: turned_size(&error.force), torque: turned_size(&error.torque) };
            let demanded = demand(connector, &wrench, &error);
            let utilisation = demanded.utilisation;
            let (force, failing) = (Vec3::zeros(), demanded.failing);
            Bridge { link, body, utilisation, wrench, force, failing, origin, axes, sign }
        }
        Link::Contact(i) => {
            let friction = structure.contacts[i].friction;
            let (force_slip, torque_slip) = (DATA * load.force_size.norm(), DATA * load.torque_size.norm());
            let escape = escape(&wrench, friction, force_slip, torque_slip);
            let utilisation = Bracket::exact(if escape.is_some() { f64::INFINITY } else { 0.0 });
            let held = Wrench::new(wrench.force, Vec3::zeros());
            let (force, failing) = (axes * held.force, escape.unwrap_or(Twist::ZERO));
            Bridge { link, body, utilisation, wrench: held, force, failing, origin, axes, sign }
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
