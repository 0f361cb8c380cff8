//! Blocks of one link: what crosses a bridge follows from balance alone.

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::Bracket;
use super::blocks::{Block, Link, Vertex};
use super::demand::{WrenchError, demand};
use super::frame::LinkFrame;
use super::loads::BodyLoad;
use super::part::Part;
use super::rung::Rung;
use super::structure::Structure;
use super::tolerances::DATA;

/// Assesses a block that consists of one link and one body that needs balance.
pub(super) fn assess_bridge(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Part {
    let (body, link) = (block.bodies[0], block.links[0]);
    let frame = LinkFrame::new(structure, link);
    let com = structure.bodies[body].com;
    let sign = if frame.plus == Vertex::Body(body) { 1.0 } else { -1.0 };
    let load = loads[body].moved(&(com - frame.origin));
    let turned = |v: &Vec3| frame.axes.tr_mul(v);
    // The link holds what the body carries: the wrench on the plus side.
    let wrench = Wrench::new(turned(&load.wrench.force), turned(&load.wrench.torque)) * -sign;
    let to_twist = |relative: &Twist| {
        let at_origin = Twist::new(frame.axes * relative.linear, frame.axes * relative.angular);
        let here = at_origin.moved(&(com - frame.origin));
        Twist::new(here.linear * sign, here.angular * sign)
    };
    match link {
        Link::Connection(i) => {
            let connector = &structure.connectors[structure.connections[i].connector];
            let error = load.error();
            let turned_size = |v: &Vec3| frame.axes.abs().tr_mul(v);
            let error = WrenchError { force: turned_size(&error.force), torque: turned_size(&error.torque) };
            let demanded = demand(connector, &wrench, &error);
            let mechanism = vec![to_twist(&demanded.failing)];
            if demanded.utilisation.lower.is_infinite() {
                return Part::Collapses { mechanism, decided_by: Rung::ClosedForm };
            }
            let critical = demanded.utilisation.lower > 0.0;
            Part::Stands {
                utilisation: demanded.utilisation,
                wrenches: vec![wrench],
                demands: vec![demanded.utilisation.upper],
                mechanism,
                shares: vec![if critical { 1.0 } else { 0.0 }],
                undecided_because: None,
                decided_by: Rung::ClosedForm,
            }
        }
        Link::Contact(i) => {
            let friction = structure.contacts[i].friction;
            let (force_slip, torque_slip) = (DATA * load.force_size.norm(), DATA * load.torque_size.norm());
            if let Some(escape) = escape(&wrench, friction, force_slip, torque_slip) {
                return Part::Collapses { mechanism: vec![to_twist(&escape)], decided_by: Rung::ClosedForm };
            }
            Part::Stands {
                utilisation: Bracket::exact(0.0),
                wrenches: vec![Wrench::new(wrench.force, Vec3::zeros())],
                demands: vec![0.0],
                mechanism: vec![Twist::ZERO],
                shares: vec![0.0],
                undecided_because: None,
                decided_by: Rung::ClosedForm,
            }
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
