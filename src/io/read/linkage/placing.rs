//! Where modules are that have no place of their own.

use std::collections::VecDeque;

use super::connections::Listed;
use crate::robot::linkage::{Linkage, Port};
use crate::spatial::Pose;

/// Places the modules that are not `placed` by the connections that lead to them from those
/// that are: breadth first, over the connections in their order. What none leads to stays where it is.
pub(super) fn place(linkage: &mut Linkage, listed: &[Listed], placed: &mut [bool]) {
    let count = linkage.modules.len();
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (index, listed) in listed.iter().enumerate() {
        for module in listed.connection.modules() {
            neighbours[module].push(index);
        }
    }
    let mut queue: VecDeque<usize> = (0..count).filter(|&module| placed[module]).collect();
    while let Some(module) = queue.pop_front() {
        for &index in &neighbours[module] {
            let Listed { connection, .. } = &listed[index];
            let [first, second] = connection.ports;
            let (near, far, is_forward) =
                if first.module == module { (first, second, true) } else { (second, first, false) };
            let Some(code) = listed[index].code() else { continue };
            if placed[far.module] {
                continue;
            }
            let across = linkage.across(connection, code);
            let across = if is_forward { across } else { across.inverse() };
            let far_body = linkage.modules[module].pose * local(linkage, near) * across;
            linkage.modules[far.module].pose = far_body * local(linkage, far).inverse();
            placed[far.module] = true;
            queue.push_back(far.module);
        }
    }
}

/// Pose of the body that a port sits on in its module's frame.
fn local(linkage: &Linkage, port: Port) -> Pose {
    let kind = linkage.module_type(port.module);
    kind.body_poses(&linkage.modules[port.module].joints)[kind.ports[port.port].body]
}
