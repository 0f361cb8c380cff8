//! The platform's own step model, on robots as they were read.

use std::collections::HashSet;

use steadfast::robot::linkage::{Connection, Linkage};
use steadfast::robot::rofi::CELL;

use crate::rofi_pairs::pairs;
use crate::{canonical, read, voxels};

/// All states one step of the platform's planner away: a joint turns by 90 degrees, the other modules are divided between the
/// sides in any way that holds together, facing docks are joined, and no two shoes share a cell.
fn steps(linkage: &Linkage) -> Vec<Linkage> {
    let mut all = Vec::new();
    for module in 0..linkage.modules.len() {
        let others: Vec<_> = (0..linkage.modules.len()).filter(|&other| other != module).collect();
        for joint in 0..3 {
            for split in 0..1 << others.len() {
                let child: Vec<_> = (0..others.len()).filter(|i| split >> i & 1 == 1).map(|i| others[i]).collect();
                if !both_hold(linkage, module, joint, &child) {
                    continue;
                }
                all.extend([-1, 1].into_iter().filter_map(|by| turned(linkage, module, joint, by, &child)));
            }
        }
    }
    all
}

/// Whether the bodies of a joint's child side, of shoe A for alpha and of shoe B and, for gamma, body B.
fn is_on_child_side(joint: usize, port: usize) -> bool {
    match joint {
        0 => port < 3,
        _ => port >= 3,
    }
}

/// Whether each side of a joint holds together with these modules on the child's side.
fn both_hold(linkage: &Linkage, module: usize, joint: usize, child: &[usize]) -> bool {
    let count = linkage.modules.len();
    // The turning module counts as two: itself for the parent's half, `count` for the child's.
    let side = |node: usize| node == count || child.contains(&node);
    let node = |port: steadfast::robot::linkage::Port| match port.module == module {
        true if is_on_child_side(joint, port.port) => count,
        _ => port.module,
    };
    let mut reached = vec![false; count + 1];
    let mut stack = vec![module, count];
    while let Some(at) = stack.pop() {
        if std::mem::replace(&mut reached[at], true) {
            continue;
        }
        for Connection { ports: [a, b] } in &linkage.connections {
            let (a, b) = (node(*a), node(*b));
            if side(a) == side(b) && (a == at || b == at) {
                stack.push(a + b - at);
            }
        }
    }
    reached.into_iter().all(|reached| reached)
}

fn turned(linkage: &Linkage, module: usize, joint: usize, by: i32, child: &[usize]) -> Option<Linkage> {
    let kind = &linkage.module_type(module).joints[joint];
    let mut next = linkage.clone();
    let position = next.modules[module].joints[joint] + by;
    if !kind.allows(position) {
        return None;
    }
    // How the child turns in W; alpha's child is the module's first body, whose pose is the module's.
    let body = linkage.body_poses(module)[kind.child];
    next.modules[module].joints[joint] = kind.canonical(position);
    let parent = linkage.body_poses(module)[kind.parent];
    let turn = parent * kind.pose(position) * body.inverse();
    if joint == 0 {
        next.modules[module].pose = turn * linkage.modules[module].pose;
    }
    for &other in child {
        next.modules[other].pose = turn * linkage.modules[other].pose;
    }
    let cells = (0..next.modules.len()).flat_map(|module| {
        let poses = next.body_poses(module);
        let far = poses[3] * nalgebra::Point3::new(0.0, 0.0, CELL);
        [poses[0].translation.vector, far.coords].map(|centre| centre.map(|x| (x / CELL).round() as i64))
    });
    let distinct: HashSet<_> = cells.collect();
    if distinct.len() != 2 * next.modules.len() {
        return None;
    }
    next.connections = next.touching();
    Some(next)
}

/// Fewest steps from one world to another, searched from both ends.
fn fewest(start: &Linkage, goal: &Linkage, at_most: usize) -> Option<usize> {
    let key = |linkage: &Linkage| canonical(&voxels(linkage));
    let mut sides = [start, goal].map(|end| (HashSet::from([key(end)]), vec![end.clone()]));
    if sides[0].0.contains(&key(goal)) {
        return Some(0);
    }
    for length in 1..=at_most {
        let which = usize::from(sides[1].1.len() < sides[0].1.len());
        let frontier = std::mem::take(&mut sides[which].1);
        for next in frontier.iter().flat_map(steps) {
            let found = key(&next);
            if sides[1 - which].0.contains(&found) {
                return Some(length);
            }
            if sides[which].0.insert(found) {
                sides[which].1.push(next);
            }
        }
    }
    None
}

/// In the platform's step model, on robots as they were read, the known least numbers of steps come out.
#[test]
fn the_platforms_step_model_finds_the_known_shortest_plans() {
    for (name, pair) in pairs() {
        let (modules, shortest) = (pair["modules"].as_u64().unwrap(), pair["shortest"].as_u64().unwrap() as usize);
        if modules > 2 && shortest > 2 {
            continue; // too many states for a test
        }
        let [start, goal] = ["start", "goal"].map(|end| read(pair[end].to_string()));
        assert_eq!(fewest(&start, &goal, shortest + 1), Some(shortest), "{name}");
    }
}
