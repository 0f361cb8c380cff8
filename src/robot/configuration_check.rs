//! Soundness of configurations, as far as the lattice tells: solids that overlap
//! the ground or obstacles are found in `geometry`.

use std::collections::HashMap;

use super::configuration::{Configuration, FaceConnection, ModuleLoad, Port};
use super::lattice::neighbour;
use super::problem::{Fault, Findings, Part, Problem};

impl Configuration {
    /// Everything that is wrong with the configuration, not counting its
    /// catalogue and what it overlaps in its environment. In the order of its parts:
    /// environment, modules, connections, loads, requirement.
    pub fn problems(&self) -> Vec<Problem> {
        let mut findings = Findings(Vec::new());
        findings.finite(Part::Configuration, "gravity", self.gravity.as_slice());
        self.environment.check(&mut findings);
        self.check_modules(&mut findings);
        self.check_connections(&mut findings);
        for (i, load) in self.loads.iter().enumerate() {
            load.check(&mut findings, i, self.modules.len());
        }
        self.require.check(&mut findings, self.modules.len());
        findings.0
    }

    fn check_modules(&self, findings: &mut Findings) {
        if self.modules.is_empty() {
            findings.add(Part::Configuration, "modules", Fault::NoModules);
        }
        findings.distinct(Part::Module, "id", self.modules.iter().map(|m| m.id.as_str()));
        let types = &self.catalogue.module_types;
        let mut cells = HashMap::new();
        let mut pitch: Option<(usize, f64)> = None;
        for (i, module) in self.modules.iter().enumerate() {
            if findings.in_range(Part::Module(i), "module_type", module.module_type, types.len()) {
                let own = types[module.module_type].cell().pitch;
                let (first, common) = *pitch.get_or_insert((i, own));
                if own != common {
                    findings.add(Part::Module(i), "module_type", Fault::DifferentPitch { first });
                }
            }
            let other = *cells.entry(module.placement.cell).or_insert(i);
            if other != i {
                findings.add(Part::Module(i), "placement", Fault::SameCell { other });
            }
        }
    }

    fn check_connections(&self, findings: &mut Findings) {
        let mut seen = HashMap::new();
        for (i, connection) in self.connections.iter().enumerate() {
            let part = Part::Connection(i);
            let [a, b] = connection.ports;
            let known = [a, b].map(|port| findings.in_range(part, "ports", port.module, self.modules.len()));
            if known != [true, true] {
                continue;
            }
            let first = *seen.entry(FaceConnection::new(a, b)).or_insert(i);
            if a.module == b.module {
                findings.add(part, "", Fault::SelfConnection);
            } else if !self.coincide(a, b) {
                findings.add(part, "", Fault::FacesApart);
            } else if first != i {
                findings.add(part, "", Fault::DuplicateConnection { first });
            } else if !self.fit(a, b) {
                findings.add(part, "", Fault::ConnectorsDoNotFit);
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

    /// Whether the faces of two ports lie on each other.
    fn coincide(&self, a: Port, b: Port) -> bool {
        let (out, back) = (self.direction(a), self.direction(b));
        let cell = |port: Port| self.modules[port.module].placement.cell;
        out == back.opposite() && neighbour(cell(a), out) == Some(cell(b))
    }

    /// Whether the connectors of two ports fit, as far as they are known.
    fn fit(&self, a: Port, b: Port) -> bool {
        let types = [a, b].map(|port| self.modules[port.module].module_type);
        let known = types.iter().all(|&t| {
            self.catalogue.module_types.get(t).is_some_and(|t| t.cell().face < self.catalogue.connectors.len())
        });
        !known || self.catalogue.face_connector(types[0], types[1]).is_some()
    }
}

impl ModuleLoad {
    /// Adds everything that is wrong with the load with this index, on one of so many modules.
    pub(super) fn check(&self, findings: &mut Findings, index: usize, modules: usize) {
        let part = Part::Load(index);
        findings.in_range(part, "module", self.module, modules);
        findings.finite(part, "force", self.force.as_slice());
        findings.finite(part, "torque", self.torque.as_slice());
        if let Some(at) = &self.at {
            findings.finite(part, "at", at.as_slice());
        }
    }
}
