//! The oracle: cuts a structure into blocks, answers for each, and puts the
//! answers together.

use crate::spatial::{Twist, Wrench};

use super::answer::Answer;
use super::assessment::{Assessment, Question};
use super::blocks::{Block, Blocks, Link, cut, short};
use super::closed_form::assess_bridge;
use super::loads::{BodyLoad, lump, own_loads};
use super::part::Part;
use super::reductions::Reductions;
use super::rejoin::rejoin;
use super::rigid_links::Merged;
use super::side_by_side::side_by_side;
use super::solve_block::assess_block;
use super::structure::Structure;
use super::tolerances::DATA;
use super::validate::{InvalidStructure, validate};

/// Bodies in several blocks from which on they are solved at the same time, some
/// milliseconds of work: for less, waiting for threads that others keep busy costs more
/// than they save.
const WORTH_THREADS: usize = 256;

/// Finds the utilisation of `structure` as a bracket, and all that follows from it.
///
/// The utilisation t is the smallest common factor on all rated strengths with
/// which every free body can be in balance,
///
/// ```text
/// t* = min t  subject to  balance, friction cones, s_l(w_l) <= t S_l,
/// ```
///
/// the internal stability margin is `1 - t*`. Both ends of the bracket are
/// evaluated from wrench and twist fields on the structure's own data, for loads
/// and directions that are meant up to a relative 1e-12. With
/// [`Question::Decide`] the answer may stop at the first block that exceeds the
/// threshold: states of the other blocks stay zero and the upper end is infinite.
///
/// # Errors
/// Non-finite or out-of-range data, or indices that point nowhere; all of them at once.
pub fn assess(structure: &Structure, question: Question) -> Result<Assessment, Vec<InvalidStructure>> {
    assess_reduced(structure, question, Reductions::ALL)
}

/// As [`assess`], with some of what a scene does not need left in.
///
/// # Errors
/// As for [`assess`].
pub fn assess_reduced(
    structure: &Structure,
    question: Question,
    reductions: Reductions,
) -> Result<Assessment, Vec<InvalidStructure>> {
    validate(structure)?;
    if reductions.rigid_links
        && let Some(merged) = Merged::new(structure)
    {
        let answer = assess_with(&merged.structure, question, reductions, &mut Unknown);
        return Ok(merged.undo(structure, answer));
    }
    Ok(assess_with(structure, question, reductions, &mut Unknown))
}

/// What is known about a structure's blocks before and after they are solved.
pub(super) trait Knowledge {
    /// What can be said about a block with cycles without solving it.
    fn bound(&mut self, structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Option<Part>;

    /// Takes note of the wrench, in its frame, of the only link of a block.
    fn note_bridge(&mut self, link: Link, wrench: &Wrench);

    /// Takes note of the answer for a block with cycles.
    fn note(&mut self, block: &Block, part: &Part);

    /// Takes note of all blocks, once all that are answered are noted.
    fn close(&mut self, blocks: &[Block]);
}

/// Nothing, for a structure that is met for the first time.
struct Unknown;

impl Knowledge for Unknown {
    fn bound(&mut self, _: &Structure, _: &Block, _: &[BodyLoad]) -> Option<Part> {
        None
    }

    fn note_bridge(&mut self, _: Link, _: &Wrench) {}

    fn note(&mut self, _: &Block, _: &Part) {}

    fn close(&mut self, _: &[Block]) {}
}

/// Answers for a valid structure. What `knowledge` answers is not solved. Rigid
/// links are none of its business.
pub(super) fn assess_with(
    structure: &Structure,
    question: Question,
    reductions: Reductions,
    knowledge: &mut impl Knowledge,
) -> Assessment {
    let pieces = pieces(structure, reductions);
    let answer = assess_pieces(structure, &pieces, question, reductions, knowledge);
    knowledge.close(&pieces.blocks);
    answer
}

/// The pieces that `structure` is solved in.
pub(super) fn pieces(structure: &Structure, reductions: Reductions) -> Blocks {
    let pieces = cut(structure);
    if reductions.blocks { pieces } else { rejoin(pieces, structure.bodies.len(), reductions.closed_form) }
}

fn assess_pieces(
    structure: &Structure,
    pieces: &Blocks,
    question: Question,
    reductions: Reductions,
    knowledge: &mut impl Knowledge,
) -> Assessment {
    let loads = lump(structure, &pieces.blocks, own_loads(structure));
    let mut answer = Answer::new(structure, &pieces.blocks);
    for &root in &pieces.afloat {
        if let Some(twist) = drift(&loads[root]) {
            answer.collapse_afloat(root, twist);
            return answer.finish();
        }
    }
    let (bridges, cyclic) = if reductions.closed_form {
        split(structure, &pieces.blocks)
    } else {
        (Vec::new(), (0..pieces.blocks.len()).collect::<Vec<_>>())
    };
    for (number, bridge) in bridges.into_iter().enumerate() {
        let Some([index, body]) = bridge else { continue };
        let link = number.checked_sub(structure.connections.len()).map_or(Link::Connection(number), Link::Contact);
        let bridge = assess_bridge(structure, link, body as usize, &loads);
        knowledge.note_bridge(link, &bridge.wrench);
        answer.add_bridge(index as usize, &bridge);
    }
    let mut open = Vec::new();
    for index in cyclic {
        if answer.settled(question) {
            answer.stop();
            return answer.finish();
        }
        match knowledge.bound(structure, &pieces.blocks[index], &loads) {
            Some(part) if part.answers(question, elsewhere(question, &answer)) => {
                knowledge.note(&pieces.blocks[index], &part);
                answer.take(index, part, question);
            }
            _ => open.push(index),
        }
    }
    // The others need not be known any better than that they do not need more than the one
    // that is expected to need most.
    if let (Question::ToGap(_), true, false) = (question, open.len() > 1, answer.settled(question)) {
        let expected = |&index: &usize| load_over_strength(structure, &pieces.blocks[index], &loads);
        let most = open.iter().map(expected).enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        let index = open.remove(most.map_or(0, |(place, _)| place));
        let block = &pieces.blocks[index];
        let part = assess_block(structure, block, &loads, question, elsewhere(question, &answer), reductions);
        answer.count_solved(block);
        knowledge.note(block, &part);
        answer.take(index, part, question);
    }
    let at_least = elsewhere(question, &answer);
    let solve = |index: &usize| assess_block(structure, &pieces.blocks[*index], &loads, question, at_least, reductions);
    // Merged in the order of the blocks, whoever was first.
    let mut ahead = Vec::new();
    let bodies: usize = open.iter().map(|&index| pieces.blocks[index].bodies.len()).sum();
    if reductions.parallel && open.len() > 1 && bodies >= WORTH_THREADS && !answer.settled(question) {
        ahead = side_by_side(&open, solve, |part| part.settles(question));
    }
    let mut ahead = ahead.into_iter();
    for index in open {
        if answer.settled(question) {
            answer.stop();
            break;
        }
        let block = &pieces.blocks[index];
        let part = ahead.next().flatten().unwrap_or_else(|| solve(&index));
        answer.count_solved(block);
        knowledge.note(block, &part);
        answer.take(index, part, question);
    }
    answer.choose(question, &loads);
    // The most of what a large tree takes, and no longer needed.
    drop(loads);
    answer.finish()
}

/// By connection, then by contact, the block that it is the only link of, and its body: what
/// bridges read and write of a large structure in this order is mostly what comes next in memory.
/// Then the other blocks.
fn split(structure: &Structure, blocks: &[Block]) -> (Vec<Option<[u32; 2]>>, Vec<usize>) {
    let connections = structure.connections.len();
    let mut bridges = vec![None; connections + structure.contacts.len()];
    let mut cyclic = Vec::new();
    for (index, block) in blocks.iter().enumerate() {
        let number = match block.links[..] {
            [Link::Connection(i)] => i,
            [Link::Contact(i)] => connections + i,
            _ => {
                cyclic.push(index);
                continue;
            }
        };
        bridges[number] = Some([short(index), short(block.bodies[0])]);
    }
    (bridges, cyclic)
}

/// What other parts of the structure need at least: of the next one, it is enough to know that
/// it needs no more. Zero where a threshold is all that is asked for, or all of the fields.
fn elsewhere(question: Question, answer: &Answer<'_>) -> f64 {
    match question {
        Question::ToGap(_) => answer.at_least(),
        Question::Decide(_) | Question::Full => 0.0,
    }
}

/// About how a block compares with others in its utilisation: all its loads over its
/// weakest connection.
fn load_over_strength(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> f64 {
    let load: f64 = block.bodies.iter().map(|&body| loads[body].wrench.force.norm()).sum();
    let strengths = block.links.iter().filter_map(|&link| match link {
        Link::Connection(i) => Some(structure.connectors[structure.connections[i].connector].strength),
        Link::Contact(_) => None,
    });
    load / strengths.fold(f64::INFINITY, f64::min)
}

/// The motion in which a body without any support is carried off by its load;
/// `None` when it is in balance.
pub(super) fn drift(load: &BodyLoad) -> Option<Twist> {
    let balanced = load.wrench.force.norm() <= DATA * load.force_size.norm()
        && load.wrench.torque.norm() <= DATA * load.torque_size.norm();
    (!balanced).then_some(Twist::new(load.wrench.force, load.wrench.torque))
}
