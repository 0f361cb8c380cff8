//! Soundness of linkages, as far as poses tell: solids that overlap are found in `geometry`.

use std::collections::HashMap;

use crate::robot::problem::{Fault, Findings, Part, Problem};

use super::{Connection, Linkage, Port};

impl Linkage {
    /// Everything that is wrong with the linkage, not counting its catalogue and what overlaps.
    /// In the order of its parts: environment, modules, connections, loads, requirement.
    pub fn problems(&self) -> Vec<Problem> {
        let mut findings = Findings(Vec::new());
        findings.finite(Part::Configuration, "gravity", self.gravity.as_slice());
        self.environment.check(&mut findings);
        let known = self.check_modules(&mut findings);
        self.check_connections(&mut findings, known);
        for (i, load) in self.loads.iter().enumerate() {
            load.check(&mut findings, i, self.modules.len());
        }
        self.require.check(&mut findings, self.modules.len());
        findings.0
    }

    /// Whether types and joints are such that ports have a place.
    fn check_modules(&self, findings: &mut Findings) -> bool {
        if self.modules.is_empty() {
            findings.add(Part::Configuration, "modules", Fault::NoModules);
        }
        findings.distinct(Part::Module, "id", self.modules.iter().map(|m| m.id.as_str()));
        let types = &self.catalogue.module_types;
        let mut known = true;
        for (i, module) in self.modules.iter().enumerate() {
            let part = Part::Module(i);
            known &= findings.finite(part, "position", module.pose.translation.vector.as_slice());
            known &= findings.finite(part, "rotation", module.pose.rotation.coords.as_slice());
            if !findings.in_range(part, "module_type", module.module_type, types.len()) {
                known = false;
                continue;
            }
            let joints = &types[module.module_type].joints;
            if joints.len() != module.joints.len() {
                findings.add(part, "joints", Fault::WrongJointCount { joints: joints.len() });
                known = false;
                continue;
            }
            for (joint, (kind, &position)) in joints.iter().zip(&module.joints).enumerate() {
                if !kind.allows(position) {
                    findings.add(part, "joints", Fault::BeyondRange { joint });
                }
            }
        }
        known
    }

    fn check_connections(&self, findings: &mut Findings, known: bool) {
        let mut seen = HashMap::new();
        for (i, connection) in self.connections.iter().enumerate() {
            let part = Part::Connection(i);
            let [a, b] = connection.ports;
            let exists = [a, b].map(|port| self.check_port(findings, part, port));
            if !known || exists != [true, true] {
                continue;
            }
            let first = *seen.entry(Connection::new(a, b)).or_insert(i);
            let kind = |port: Port| [self.modules[port.module].module_type, port.port];
            if a.module == b.module {
                findings.add(part, "", Fault::SelfConnection);
            } else if self.catalogue.connector_between(kind(a), kind(b)).is_none() {
                findings.add(part, "", Fault::PortsDoNotFit);
            } else if self.engagement(connection).is_none() {
                findings.add(part, "", Fault::PortsApart);
            } else if first != i {
                findings.add(part, "", Fault::DuplicateConnection { first });
            }
        }
        if self.require.connected {
            for (module, component) in self.components().into_iter().enumerate() {
                if module == component && module != 0 {
                    findings.add(Part::Module(module), "", Fault::Disconnected);
                }
            }
        }
    }

    fn check_port(&self, findings: &mut Findings, part: Part, port: Port) -> bool {
        findings.in_range(part, "ports", port.module, self.modules.len())
            && self
                .catalogue
                .module_types
                .get(self.modules[port.module].module_type)
                .is_some_and(|module_type| findings.in_range(part, "ports", port.port, module_type.ports.len()))
    }
}
