//! Random numbers that are the same everywhere and for ever.
//!
//! The generator is fixed (ChaCha8, whose words are specified), and how words become choices is written
//! down here rather than left to a library that may choose otherwise in its next version.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::robot::{Face, Orientation};

/// What random numbers are for: each has a stream of its own.
#[derive(Clone, Copy, Debug)]
pub enum Purpose {
    Surroundings,
    Start,
    Goal,
}

/// A stream of random choices.
#[derive(Clone, Debug)]
pub struct Draw(ChaCha8Rng);

impl Draw {
    pub fn new(seed: u64, purpose: Purpose) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(purpose as u64);
        Self(generator)
    }

    /// A number below `count`, which is not 0, all equally likely.
    pub fn below(&mut self, count: usize) -> usize {
        let count = count as u64;
        // The words from here on would make small numbers likelier.
        let fair = u64::MAX - (u64::MAX % count + 1) % count;
        loop {
            let word = self.0.next_u64();
            if word <= fair {
                return (word % count) as usize;
            }
        }
    }

    /// One of these, of which there is at least one.
    pub fn choose<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        &items[self.below(items.len())]
    }

    /// One of the 24 rotations of a cube.
    pub fn orientation(&mut self) -> Orientation {
        *self.choose(&orientations())
    }

    /// One of the four rotations of a cube that turn z to this direction.
    pub fn orientation_towards(&mut self, direction: Face) -> Orientation {
        let mut towards = orientations();
        towards.retain(|orientation| orientation.to_world(Face::PosZ) == direction);
        *self.choose(&towards)
    }
}

/// The 24 rotations of a cube, in their order.
fn orientations() -> Vec<Orientation> {
    let mut all = vec![Orientation::IDENTITY];
    let mut next = 0;
    while next < all.len() {
        for axis in [Face::PosX, Face::PosZ] {
            let turned = all[next].turned(Orientation::quarter_turn(axis));
            if !all.contains(&turned) {
                all.push(turned);
            }
        }
        next += 1;
    }
    all.sort_unstable();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_and_repeat() {
        let words = |seed, purpose| {
            let mut draw = Draw::new(seed, purpose);
            (0..20).map(|_| draw.below(1000)).collect::<Vec<_>>()
        };
        assert_eq!(words(7, Purpose::Start), words(7, Purpose::Start));
        assert_ne!(words(7, Purpose::Start), words(7, Purpose::Goal));
        assert_ne!(words(7, Purpose::Start), words(8, Purpose::Start));
    }

    #[test]
    fn the_generator_is_chacha8() {
        // First block of ChaCha8 for a key and a nonce of zeros, from the test vectors of its
        // specification (draft-strombergson-chacha-test-vectors-01, TC1): 3e 00 ef 2f 89 5f 40 d6 ..
        let mut draw = Draw::new(0, Purpose::Surroundings);
        assert_eq!(draw.0.next_u64().to_le_bytes(), [0x3e, 0x00, 0xef, 0x2f, 0x89, 0x5f, 0x40, 0xd6]);
    }

    #[test]
    fn all_choices_are_about_equally_likely() {
        let mut draw = Draw::new(1, Purpose::Goal);
        let mut counts = [0_u32; 7];
        for _ in 0..7000 {
            counts[draw.below(7)] += 1;
        }
        // Five standard deviations of a binomial distribution: sqrt(7000 6/49) = 29.
        assert!(counts.iter().all(|count| count.abs_diff(1000) < 150), "{counts:?}");
    }

    #[test]
    fn a_cube_has_24_orientations_of_which_four_look_the_same_way() {
        assert_eq!(orientations().len(), 24);
        let mut draw = Draw::new(3, Purpose::Start);
        for direction in Face::ALL {
            assert_eq!(draw.orientation_towards(direction).to_world(Face::PosZ), direction);
        }
    }
}
