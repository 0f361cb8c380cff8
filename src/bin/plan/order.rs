//! `plan check --order`: the order in which connections would give way, in words.

use steadfast::io::NamedStructure;
use steadfast::statics::FailureOrder;

use crate::explain::wrapped;
use crate::gives_way::listed;

/// A line for every level, the most loaded first.
pub fn order(named: &NamedStructure, order: &FailureOrder) -> String {
    let names = |connections: &[usize]| {
        let ids: Vec<&str> = connections.iter().map(|&i| named.connections[i].as_str()).collect();
        listed(&ids)
    };
    let mut text = "\nthe order in which connections would give way\n".to_owned();
    if order.levels.is_empty() {
        text.push_str(&wrapped("none: nothing has to flow through them"));
    }
    for (index, level) in order.levels.iter().enumerate() {
        let bracket = level.utilisation;
        let value = 0.5 * (bracket.lower + bracket.upper);
        let within = if bracket.width() <= 5e-7 { String::new() } else { format!(" within {:.0e}", bracket.width()) };
        text.push_str(&wrapped(&format!("{}. at {value:.6}{within}: {}", index + 1, names(&level.connections))));
    }
    if !order.idle.is_empty() {
        text.push_str(&wrapped(&format!("nothing has to flow through {}", names(&order.idle))));
    }
    if !order.open.is_empty() {
        text.push_str(&wrapped(&format!("not gone into: {}", names(&order.open))));
    }
    text
}
