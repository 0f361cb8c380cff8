//! How people see modules, ports and actions.

use steadfast::reconfigure::Action;
use steadfast::robot::{Cell, Configuration, FaceConnection, Port};

/// `a:+x`, a port of the start's modules.
pub fn port(start: &Configuration, port: Port) -> String {
    format!("{}:{}", start.modules[port.module].id, port.face.name())
}

/// `a:+x - b:-x`.
pub fn connection(start: &Configuration, connection: &FaceConnection) -> String {
    let [first, second] = connection.ports;
    format!("{} - {}", port(start, first), port(start, second))
}

/// What an action does, in a few words.
pub fn action(start: &Configuration, action: &Action) -> String {
    let id = |module: usize| &start.modules[module].id;
    match action {
        Action::Attach(pair) | Action::Detach(pair) => format!("{} {}", action.kind(), connection(start, pair)),
        Action::Slide { module, to } => format!("slide  {} to {}", id(*module), cell(*to)),
        Action::Pivot { module, support, to } => {
            format!("pivot  {} about {} to {}", id(*module), id(*support), cell(*to))
        }
    }
}

fn cell([x, y, z]: Cell) -> String {
    format!("[{x}, {y}, {z}]")
}
