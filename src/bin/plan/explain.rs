//! `plan check --explain`: what was left out of a scene and why, in words.

use steadfast::io::{NamedStructure, in_space_because};
use steadfast::statics::{Explanation, Remaining};

use crate::table::table;

/// Longest line.
const WIDTH: usize = 79;

/// Most blocks that are listed one by one.
const LISTED: usize = 10;

/// A paragraph for every reduction, and a table of what remained.
pub fn explained(named: &NamedStructure, explanation: &Explanation) -> String {
    let mut text = "\nleft out of the optimisation\n".to_owned();
    for item in left_out(named, explanation) {
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

fn left_out(named: &NamedStructure, explanation: &Explanation) -> Vec<String> {
    let structure = &named.structure;
    let blocks = &explanation.remaining;
    let sum = |of: fn(&Remaining) -> usize| blocks.iter().map(of).sum::<usize>();
    let mut items = Vec::new();
    let mut tell = |count: usize, item: String| {
        if count > 0 {
            items.push(item);
        }
    };
    let Explanation { fixed_bodies, merged_bodies, unlimited_connections, idle_links, unloaded_blocks, .. } =
        *explanation;
    tell(
        fixed_bodies,
        format!("{}: immovable, so their balance is no equation", count(fixed_bodies, "fixed body", "fixed bodies")),
    );
    tell(
        merged_bodies,
        format!(
            "{} moving with others: {} without any finite limit hold them; what those carry follows from balance afterwards",
            count(merged_bodies, "body", "bodies"),
            count(unlimited_connections, "connection", "connections"),
        ),
    );
    tell(
        idle_links,
        format!(
            "{} between things that cannot move against each other: need carry nothing",
            count(idle_links, "link", "links")
        ),
    );
    let closed = explanation.closed_form_connections + explanation.closed_form_contacts;
    tell(
        closed,
        format!(
            "{} and {} in closed form: each is all that holds what hangs behind it, so its wrench follows from balance",
            count(explanation.closed_form_connections, "connection", "connections"),
            count(explanation.closed_form_contacts, "contact", "contacts"),
        ),
    );
    tell(
        usize::from(blocks.len() > 1),
        format!(
            "{} blocks that meet in single bodies or at the ground: solved one by one, each only until it is proved to need no more than another",
            blocks.len()
        ),
    );
    tell(unloaded_blocks, format!("{} without any load: nothing to hold", count(unloaded_blocks, "block", "blocks")));
    let (chains, within) = (sum(|block| block.chains), sum(|block| block.bodies_in_chains));
    tell(
        chains,
        format!(
            "{} within {}: a body with two connections passes its wrench on, so each chain has one unknown wrench",
            count(within, "body", "bodies"),
            count(chains, "chain", "chains"),
        ),
    );
    let planar = sum(|block| usize::from(block.is_planar()));
    tell(
        planar,
        format!(
            "{} in a plane ({}): no force across it and no torque within it, so three equations a body; points in mirrored pairs are one, and a point's friction cone is two inequalities",
            count(planar, "block lies", "blocks lie"),
            count(sum(|block| if block.is_planar() { block.bodies } else { 0 }), "body", "bodies"),
        ),
    );
    if !blocks.is_empty() {
        if sum(|block| block.friction_cones) == 0 {
            let why = match structure.contacts.iter().any(|contact| contact.friction > 0.0) {
                _ if structure.contacts.is_empty() => "there is no contact",
                true => "none with friction is left in what is solved, or only in planes",
                false => "no contact has friction",
            };
            items.push(format!("friction cones of contacts: {why}"));
        }
        if explanation.is_linear() {
            items.push(
                "second-order cones: boxes, no friction or friction in planes are left, a linear program".to_owned(),
            );
        } else if sum(|block| block.inequalities) == 0 {
            items.push("linear inequalities: no box and no frictionless point is left".to_owned());
        }
    }
    items.push("a secondary objective and the distribution of stress: only the margin was asked for".to_owned());
    items
}

fn count(number: usize, one: &str, several: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { several })
}

/// An item of a list, broken into lines.
fn wrapped(item: &str) -> String {
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
