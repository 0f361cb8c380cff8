//! The actions of a plan for a linkage.

use super::super::codes;
use super::super::document::LinkageProblem;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::angle::steps;
use super::linkage::{angles, port};
use super::module_type::refuse;
use super::names::Names;
use super::sequence::{Family, Held as Said};
use crate::reconfigure::Which;
use crate::reconfigure::linkage::assembly::Held;
use crate::reconfigure::linkage::{Action, Half};
use crate::robot::linkage::{Connection, Linkage};

/// Reads plans for linkages.
pub(super) struct LinkagePlans<'a> {
    start: Robot<'a>,
    goal: Robot<'a>,
}

/// A linkage and the names of its modules.
struct Robot<'a> {
    linkage: &'a Linkage,
    modules: Names<'a>,
}

impl<'a> LinkagePlans<'a> {
    /// Reads plans for a problem, which stands at `root`.
    pub(super) fn new(problem: &'a LinkageProblem, root: &Place<'_>, findings: &mut Findings) -> Self {
        let mut robot = |linkage: &'a Linkage| {
            let ids = linkage.modules.iter().map(|module| module.id.as_str()).collect();
            Robot { linkage, modules: Names::new("modules", ids, |_| root.clone(), findings) }
        };
        Self { start: robot(&problem.start), goal: robot(&problem.goal.linkage) }
    }
}

impl Robot<'_> {
    /// The connection of two ports, which stand at `place`.
    fn pair(&self, texts: &[String; 2], place: &Place<'_>, findings: &mut Findings) -> Option<Connection> {
        let kind = |module: usize| self.linkage.modules.get(module).map(|module| module.module_type);
        let catalogue = &self.linkage.catalogue;
        let [a, b] = [0, 1].map(|i| port(&texts[i], &self.modules, catalogue, kind, &place.index(i), findings));
        Some(Connection::new(a?, b?))
    }

    /// A module and one of its joints, by their names.
    fn joint(&self, module: &str, joint: &str, place: &Place<'_>, findings: &mut Findings) -> Option<[usize; 2]> {
        let module = self.modules.find(module, &place.key("module"), findings)?;
        let joints = self.linkage.module_type(module).joints.iter().map(|joint| joint.name.as_str()).collect();
        let place = place.key("joint");
        let joints = Names::new("joints", joints, |_| place.clone(), findings);
        Some([module, joints.find(joint, &place, findings)?])
    }
}

impl Family for LinkagePlans<'_> {
    type Action = Action;
    type Connection = Held;

    fn begin(&mut self, _plan: usize) {}

    fn action(
        &mut self,
        _index: usize,
        wire: &wire::Action,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<Action> {
        let start = &self.start;
        Some(match wire {
            wire::Action::Attach { ports, .. } => Action::Attach(start.pair(ports, &place.key("ports"), findings)?),
            wire::Action::Detach { ports, .. } => Action::Detach(start.pair(ports, &place.key("ports"), findings)?),
            wire::Action::Roll { ports, carried, to, .. } => {
                let connection = start.pair(ports, &place.key("ports"), findings);
                let module = start.modules.find(carried, &place.key("carried"), findings);
                let spot = [to.azimuth_deg, to.polar_deg, to.spin_deg];
                let to = angles(spot, &place.key("to"), findings);
                let (connection, carried) = (connection?, module?);
                if !connection.modules().contains(&carried) {
                    let message = "neither of the two ports is of this module";
                    let hint = "name the module of the two whose side moves".to_string();
                    findings.add(&place.key("carried"), codes::PLAN, message, hint);
                    return None;
                }
                Action::Roll { connection, to: to?, carried }
            }
            wire::Action::Rotate { module, joint, to_deg, carried, .. } => {
                let [module, joint] = start.joint(module, joint, place, findings)?;
                let step = start.linkage.module_type(module).joints[joint].step_degrees;
                let Some(to) = steps(to_deg.0, step) else {
                    let message = format!("{} degrees are no whole number of steps of {step}", to_deg.0);
                    let hint = format!("the nearest step is at {} degrees", (to_deg.0 / step).round() * step);
                    findings.add(&place.key("to_deg"), codes::OUT_OF_RANGE, message, hint);
                    return None;
                };
                let carried = match carried {
                    wire::Half::Parent => Half::Parent,
                    wire::Half::Child => Half::Child,
                };
                Action::Rotate { module, joint, to, carried }
            }
            wire::Action::Slide { .. } | wire::Action::Pivot { .. } | wire::Action::Move { .. } => {
                let hint = "here modules roll and rotate";
                refuse(
                    &place.key("kind"),
                    "is a motion of robots all of whose modules sit in a lattice",
                    hint,
                    findings,
                );
                return None;
            }
        })
    }

    fn connection(&self, which: Which, held: Said<'_>, place: &Place<'_>, findings: &mut Findings) -> Option<Held> {
        let robot = match which {
            Which::Start => &self.start,
            Which::Goal => &self.goal,
        };
        match held {
            Said::Ports(ports) => robot.pair(ports, &place.key("connection"), findings).map(Held::Ports),
            Said::Joint(wire::JointOf { module, joint }) => {
                let [module, joint] = robot.joint(module, joint, &place.key("joint"), findings)?;
                Some(Held::Joint { module, joint })
            }
        }
    }
}
