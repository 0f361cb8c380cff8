//! The actions of a plan for a linkage.

use super::super::assembled::port_name;
use super::super::document::LinkageProblem;
use super::super::wire::{self, Real};
use super::Unwritable;
use super::sequence::{Family, Named, Worth};
use crate::reconfigure::Which;
use crate::reconfigure::linkage::assembly::Held;
use crate::reconfigure::linkage::{Action, Half};
use crate::robot::linkage::{Connection, Linkage, MICRO, Spot};

/// Writes plans for a problem.
pub(super) struct LinkagePlans<'a> {
    pub(super) problem: &'a LinkageProblem,
}

impl Family for LinkagePlans<'_> {
    type Action = Action;
    type Connection = Held;

    fn begin(&mut self, _plan: usize) {}

    fn action(&mut self, _index: usize, action: &Action, (margin, phase): Worth) -> Result<wire::Action, Unwritable> {
        let start = &self.problem.start;
        Ok(match *action {
            Action::Attach(pair) => wire::Action::Attach { ports: ports(start, pair)?, margin, phase },
            Action::Detach(pair) => wire::Action::Detach { ports: ports(start, pair)?, margin, phase },
            Action::Roll { connection, to, carried } => {
                let (ports, carried) = (ports(start, connection)?, id(start, carried)?);
                wire::Action::Roll { ports, carried, to: spot(to), margin, phase }
            }
            Action::Rotate { module, joint, to, carried } => {
                let wire::JointOf { module: id, joint: name } = joint_of(start, module, joint)?;
                let step = start.module_type(module).joints[joint].step_degrees;
                let carried = match carried {
                    Half::Parent => wire::Half::Parent,
                    Half::Child => wire::Half::Child,
                };
                let to_deg = Real(f64::from(to) * step);
                wire::Action::Rotate { module: id, joint: name, to_deg, carried, margin, phase }
            }
        })
    }

    fn held(&self, which: Which, held: Held) -> Result<Named, Unwritable> {
        let linkage = match which {
            Which::Start => &self.problem.start,
            Which::Goal => &self.problem.goal.linkage,
        };
        Ok(match held {
            Held::Ports(connection) => (Some(ports(linkage, connection)?), None),
            Held::Joint { module, joint } => (None, Some(joint_of(linkage, module, joint)?)),
        })
    }
}

fn spot(spot: Spot) -> wire::SpotTarget {
    let degrees = |micro: i32| Real(f64::from(micro) / f64::from(MICRO));
    wire::SpotTarget {
        azimuth_deg: degrees(spot.azimuth()),
        polar_deg: degrees(spot.polar()),
        spin_deg: degrees(spot.spin()),
    }
}

fn id(linkage: &Linkage, module: usize) -> Result<String, Unwritable> {
    let found = linkage.modules.get(module);
    Ok(found.ok_or_else(|| Unwritable::new("an action on a module beyond those there are"))?.id.clone())
}

fn joint_of(linkage: &Linkage, module: usize, joint: usize) -> Result<wire::JointOf, Unwritable> {
    let id = id(linkage, module)?;
    let found = linkage.module_type(module).joints.get(joint);
    let joint = found.ok_or_else(|| Unwritable::new("a joint that its module does not have"))?;
    Ok(wire::JointOf { module: id, joint: joint.name.clone() })
}

/// The two ports of a connection between modules of a linkage.
fn ports(linkage: &Linkage, connection: Connection) -> Result<[String; 2], Unwritable> {
    for port in connection.ports {
        id(linkage, port.module)?;
        if port.port >= linkage.module_type(port.module).ports.len() {
            return Err(Unwritable::new("a port that its module does not have"));
        }
    }
    Ok(connection.ports.map(|port| port_name(linkage, port)))
}
