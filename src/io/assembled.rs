//! The structure of a robot, with names that say what each part is.

use super::document::NamedStructure;
use crate::reconfigure::assembly::{Touched, assemble};
use crate::reconfigure::linkage::assembly::{self, Assembly, BodyOf, Held};
use crate::robot::linkage::{Linkage, Port};
use crate::robot::{Configuration, ModuleType};

impl NamedStructure {
    /// The structure of a sound configuration as it stands. Bodies have the
    /// modules' ids; a connection is called by its ports (`a:+z b:-z`), a contact by
    /// what touches and its number (`a on ground 1`).
    pub fn of_configuration(configuration: &Configuration) -> Self {
        let assembly = assemble(configuration);
        let id = |module: usize| configuration.modules[module].id.as_str();
        let connections = assembly.connections.iter().map(|&index| {
            let ports = configuration.connections[index].ports;
            ports.map(|port| format!("{}:{}", id(port.module), port.face.name())).join(" ")
        });
        let mut number = 0;
        let mut last = None;
        let contacts = assembly.contacts.iter().map(|&pair| {
            number = if last == Some(pair) { number + 1 } else { 1 };
            last = Some(pair);
            let against = match pair.1 {
                Touched::Module(other) => id(other).to_string(),
                Touched::Ground => "ground".to_string(),
                Touched::Obstacle(index) => format!("obstacle {index}"),
            };
            format!("{} on {against} {number}", id(pair.0))
        });
        Self {
            bodies: configuration.modules.iter().map(|module| module.id.clone()).collect(),
            connections: connections.collect(),
            contacts: contacts.collect(),
            structure: assembly.structure,
        }
    }

    /// The structure of a sound linkage as it stands. A body is called by its module's id, followed by a dot and
    /// its own name where the module has several (`a.shoe`); a joint likewise (`a.alpha`), a connection by its
    /// ports (`s:top n:surface`), a contact by what touches and its number (`n on ground 1`).
    pub fn of_linkage(linkage: &Linkage) -> Self {
        let Assembly { structure, bodies, connections, contacts } = assembly::assemble(linkage);
        let mut number = 0;
        let mut last = None;
        let contacts = contacts.iter().map(|&pair| {
            number = if last == Some(pair) { number + 1 } else { 1 };
            last = Some(pair);
            let against = match pair.1 {
                assembly::Touched::Body(other) => body_name(linkage, other),
                assembly::Touched::Ground => "ground".to_string(),
                assembly::Touched::Obstacle(index) => format!("obstacle {index}"),
            };
            format!("{} on {against} {number}", body_name(linkage, pair.0))
        });
        Self {
            bodies: bodies.iter().map(|&body| body_name(linkage, body)).collect(),
            connections: connections.iter().map(|&held| held_name(linkage, held)).collect(),
            contacts: contacts.collect(),
            structure,
        }
    }
}

/// A port as files write it, e.g. `s:top`.
pub(super) fn port_name(linkage: &Linkage, port: Port) -> String {
    format!("{}:{}", linkage.modules[port.module].id, linkage.module_type(port.module).ports[port.port].name)
}

fn body_name(linkage: &Linkage, BodyOf { module, body }: BodyOf) -> String {
    let (id, ModuleType { bodies, .. }) = (&linkage.modules[module].id, linkage.module_type(module));
    if bodies.len() == 1 { id.clone() } else { format!("{id}.{}", bodies[body].name) }
}

fn held_name(linkage: &Linkage, held: Held) -> String {
    match held {
        Held::Ports(connection) => connection.ports.map(|port| port_name(linkage, port)).join(" "),
        Held::Joint { module, joint } => {
            format!("{}.{}", linkage.modules[module].id, linkage.module_type(module).joints[joint].name)
        }
    }
}
