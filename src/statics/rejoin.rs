//! Puts blocks together again, so that what cutting saves can be measured.

use super::blocks::{Block, Blocks, Vertex};

/// Joins every block to the one that holds its root, and all that hang from the
/// same body or from the ground. Blocks of one link stay apart where
/// `bridges_apart`, as they are answered in closed form.
///
/// The pieces are as valid as they were: every block comes after the one that
/// holds its root, and needs its root held and the loads that hang from it.
pub(super) fn rejoin(pieces: Blocks, bodies: usize, bridges_apart: bool) -> Blocks {
    let number = |vertex: Vertex| match vertex {
        Vertex::Ground => bodies,
        Vertex::Body(i) => i,
    };
    // The joined block that what hangs from a vertex belongs to.
    let mut home: Vec<Option<usize>> = vec![None; bodies + 1];
    let mut blocks: Vec<Block> = Vec::new();
    for block in pieces.blocks {
        if bridges_apart && block.links.len() == 1 {
            blocks.push(block);
            continue;
        }
        let root = number(block.root);
        let place = *home[root].get_or_insert(blocks.len());
        for &body in &block.bodies {
            home[body] = Some(place);
        }
        if place == blocks.len() {
            blocks.push(block);
        } else {
            blocks[place].bodies.extend(block.bodies);
            blocks[place].links.extend(block.links);
        }
    }
    for block in &mut blocks {
        block.bodies.sort_unstable();
        block.links.sort_unstable();
    }
    Blocks { blocks, afloat: pieces.afloat }
}

#[cfg(test)]
mod tests {
    use super::super::blocks::{Link, cut};
    use super::super::structure::{Anchor, Body, Contact, Structure};
    use super::*;
    use crate::spatial::Vec3;

    /// Bodies that touch as `pairs` say; 0 is the world, `i + 1` is body `i`.
    fn pieces(bodies: usize, pairs: &[[usize; 2]], bridges_apart: bool) -> Blocks {
        let anchor = |i: usize| if i == 0 { Anchor::World } else { Anchor::Body(i - 1) };
        let contacts = pairs.iter().map(|&[a, b]| Contact {
            body: a.max(b) - 1,
            against: anchor(a.min(b)),
            position: Vec3::zeros(),
            normal: Vec3::z(),
            friction: 0.5,
        });
        let body = Body { mass: 1.0, com: Vec3::zeros(), fixed: false };
        let structure = Structure { bodies: vec![body; bodies], contacts: contacts.collect(), ..Structure::default() };
        rejoin(cut(&structure), bodies, bridges_apart)
    }

    /// Two triangles on the ground, a third on one of them, a bridge, and a fourth behind it.
    const PAIRS: [[usize; 2]; 13] =
        [[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0], [2, 5], [5, 6], [6, 2], [6, 7], [7, 8], [8, 9], [9, 7]];

    #[test]
    fn without_bridges_all_that_hangs_together_is_one_block() {
        let joined = pieces(9, &PAIRS, false);
        assert_eq!(joined.blocks.len(), 1);
        assert_eq!(joined.blocks[0].root, Vertex::Ground);
        assert!(joined.blocks[0].bodies.iter().copied().eq(0..9));
        assert!(joined.blocks[0].links.iter().copied().eq((0..13).map(Link::Contact)));
    }

    #[test]
    fn bridges_stay_apart_and_hold_what_is_behind_them() {
        let joined = pieces(9, &PAIRS, true);
        let shapes: Vec<_> = joined.blocks.iter().map(|block| (block.root, &block.bodies[..])).collect();
        let expected: [(Vertex, &[usize]); 3] =
            [(Vertex::Ground, &[0, 1, 2, 3, 4, 5]), (Vertex::Body(5), &[6]), (Vertex::Body(6), &[7, 8])];
        assert_eq!(shapes, expected);
    }

    #[test]
    fn what_is_afloat_stays_afloat() {
        let joined = pieces(5, &[[0, 1], [2, 3], [3, 4], [4, 2], [4, 5]], false);
        assert_eq!((joined.blocks.len(), &joined.afloat[..]), (2, &[1][..]));
        assert!(joined.blocks.iter().any(|block| block.root == Vertex::Body(1) && block.bodies[..] == [2, 3, 4]));
    }
}
