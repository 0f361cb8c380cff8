//! The structure of a configuration, with names that say what each part is.

use super::document::NamedStructure;
use crate::reconfigure::assembly::{Touched, assemble};
use crate::robot::Configuration;

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
}
