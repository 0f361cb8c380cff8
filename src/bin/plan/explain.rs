//! `plan check --explain`: what was left out of a scene and why, in words.

use steadfast::io::{NamedStructure, in_space_because};
use steadfast::statics::{Explanation, Remaining};

use crate::table::table;

/// Longest line.
const WIDTH: usize = 79;

/// Most blocks that are listed one by one.
const LISTED: usize = 10;

/// A paragraph for every reduction, and a table of what remained. `margin_only` says that no
/// distribution of stress was asked for.
pub fn explained(named: &NamedStructure, explanation: &Explanation, margin_only: bool) -> String {
    let mut text = "\nleft out of the optimisation\n".to_owned();
    for item in left_out(named, explanation, margin_only) {
        text.push_str(&wrapped(&item));
    }
    text.push_str("\nwhat remained\n");
    let blocks = &explanation.remaining;
    if blocks.is_empty() {
        text.push_str(&wrapped("nothing: no solver was asked"));
        return text;
    }
    let mut largest: Vec<&Remaining> = blocks.iter().collect();
    largest.sort_by_key(|block| std::cmp::Reverse(block.bodies));
    let row = |block: &&Remaining| {
        let cones = block.friction_cones + block.connector_cones;
        [block.bodies, block.unknown_wrenches, block.equations, cones, block.inequalities]
            .map(|n| n.to_string())
            .to_vec()
    };
    let rows: Vec<_> = largest.iter().take(LISTED).map(row).collect();
    text.push_str(&table(&["bodies", "unknown wrenches", "equations", "cones", "inequalities"], &rows));
    if blocks.len() > LISTED {
        text.push_str(&wrapped(&format!("and {} more blocks, none larger", blocks.len() - LISTED)));
    }
    text.push_str(&solved_in_space(named, blocks));
    text
}

/// Why blocks have six equations a body, those with the same reason in one item.
fn solved_in_space(named: &NamedStructure, blocks: &[Remaining]) -> String {
    let mut reasons: Vec<(String, usize)> = Vec::new();
    for why in blocks.iter().filter_map(|block| block.in_space) {
        let why = in_space_because(named, why);
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, blocks)) => *blocks += 1,
            None => reasons.push((why, 1)),
        }
    }
    let item = |(why, blocks): &(String, usize)| {
        wrapped(&format!("{} with six equations a body: {why}", count(*blocks, "block", "blocks")))
    };
    let listed: String = reasons.iter().take(LISTED).map(item).collect();
    match reasons.len().checked_sub(LISTED) {
        None | Some(0) => listed,
        Some(more) => listed + &wrapped(&format!("and {more} more reasons of the same kinds")),
    }
}

fn left_out(named: &NamedStructure, explanation: &Explanation, margin_only: bool) -> Vec<String> {
    let reduced = bodies(explanation).into_iter().chain(blocks(explanation));
    let mut items: Vec<String> = reduced.filter(|(found, _)| *found > 0).map(|(_, item)| item).collect();
    items.extend(cones(named, explanation));
    if margin_only {
        items.push("a secondary objective and the distribution of stress: only the margin was asked for".to_owned());
    }
    items
}

/// What bodies and links need no equation or no unknown, with how many of them there are.
fn bodies(explanation: &Explanation) -> [(usize, String); 4] {
    let Explanation { fixed_bodies, merged_bodies, idle_links, .. } = *explanation;
    let (connections, contacts) = (explanation.closed_form_connections, explanation.closed_form_contacts);
    let held_by = some_connections(explanation.unlimited_connections);
    let fixed = count(fixed_bodies, "fixed body", "fixed bodies");
    let merged = some_bodies(merged_bodies);
    let idle = count(idle_links, "link", "links");
    let closed = format!("{} and {}", some_connections(connections), count(contacts, "contact", "contacts"));
    [
        (fixed_bodies, fixed + ": immovable, so their balance is no equation"),
        (
            merged_bodies,
            format!(
                "{merged} moving with others: {held_by} without any finite limit hold them; what those carry follows from balance afterwards"
            ),
        ),
        (idle_links, idle + " between things that cannot move against each other: need carry nothing"),
        (
            connections + contacts,
            closed + " in closed form: each is all that holds what hangs behind it, so its wrench follows from balance",
        ),
    ]
}

/// What makes blocks smaller, with how often it does.
fn blocks(explanation: &Explanation) -> [(usize, String); 4] {
    let blocks = &explanation.remaining;
    let sum = |of: fn(&Remaining) -> usize| blocks.iter().map(of).sum::<usize>();
    let (chains, within) = (sum(|block| block.chains), sum(|block| block.bodies_in_chains));
    let planar = sum(|block| usize::from(block.is_planar()));
    let in_planes = some_bodies(sum(|block| if block.is_planar() { block.bodies } else { 0 }));
    let lie = count(planar, "block lies", "blocks lie");
    let unloaded = count(explanation.unloaded_blocks, "block", "blocks");
    [
        (
            usize::from(blocks.len() > 1),
            format!(
                "{} blocks that meet in single bodies or at the ground: solved one by one, each only until it is proved to need no more than another",
                blocks.len()
            ),
        ),
        (explanation.unloaded_blocks, unloaded + " without any load: nothing to hold"),
        (
            chains,
            format!(
                "{} within {}: a body with two connections passes its wrench on, so each chain has one unknown wrench",
                some_bodies(within),
                count(chains, "chain", "chains")
            ),
        ),
        (
            planar,
            format!(
                "{lie} in a plane ({in_planes}): no force across it and no torque within it, so three equations a body; points in mirrored pairs are one, and a point's friction cone is two inequalities"
            ),
        ),
    ]
}

/// Which kinds of cone do not occur, and why.
fn cones(named: &NamedStructure, explanation: &Explanation) -> Vec<String> {
    let (structure, blocks) = (&named.structure, &explanation.remaining);
    let mut items = Vec::new();
    if blocks.is_empty() {
        return items;
    }
    if blocks.iter().all(|block| block.friction_cones == 0) {
        let why = match structure.contacts.iter().any(|contact| contact.friction > 0.0) {
            _ if structure.contacts.is_empty() => "there is no contact",
            true => "none with friction is left in what is solved, or only in planes",
            false => "no contact has friction",
        };
        items.push(format!("friction cones of contacts: {why}"));
    }
    if explanation.is_linear() {
        items
            .push("second-order cones: boxes, no friction or friction in planes are left, a linear program".to_owned());
    } else if blocks.iter().all(|block| block.inequalities == 0) {
        items.push("linear inequalities: no box and no frictionless point is left".to_owned());
    }
    items
}

fn some_bodies(number: usize) -> String {
    count(number, "body", "bodies")
}

fn some_connections(number: usize) -> String {
    count(number, "connection", "connections")
}

fn count(number: usize, one: &str, several: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { several })
}

/// An item of a list, broken into lines.
pub fn wrapped(item: &str) -> String {
    let (mut text, mut line) = (String::new(), "  -".to_owned());
    for word in item.split(' ') {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            text.push_str(&line);
            text.push('\n');
            line = "   ".to_owned();
        }
        line.push(' ');
        line.push_str(word);
    }
    text + &line + "\n"
}
