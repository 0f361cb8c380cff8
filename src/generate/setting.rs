//! What a random robot stands on.
//!
//! All ground consists of tiles as large as a cell, so that what stands on one tile stands on it squarely. A slope
//! is a flat floor whose gravity is tilted: the floor's own frame is the world's.

use std::sync::Arc;

use crate::robot::{Environment, Ground, HeightField, Obstacle, Shape, Terrain};
use crate::spatial::{Pose, Vec3};

use super::draw::Draw;

/// Standard gravity in m/s^2, as the problem library has it.
const GRAVITY: f64 = 9.81;

/// Friction of all ground, as the problem library has it.
const FRICTION: f64 = 0.6;

/// Side of a block of a stepped floor, in tiles.
const BLOCK: i32 = 2;

/// Heights of blocks in cells: of six blocks three are low, two are one cell high and one is two cells high.
const STEPS: [i32; 6] = [0, 0, 0, 1, 1, 2];

/// Of three tiles of a rough floor, one is a pit.
const ONE_PIT_IN: usize = 3;

/// Depths of pits come in twentieths of a cell, up to half a cell.
const DEPTHS: usize = 10;

/// Tiles around the region that robots grow in, to move on.
const BORDER: i32 = 3;

/// What surrounds the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Setting {
    /// Nothing, not even gravity; the goal is met anywhere.
    Space,
    /// Gravity and no ground: the robot hangs on its first module, which is held.
    Mounted,
    /// A floor with a friction coefficient of 0.6.
    Flat,
    /// The same, inclined by 1, 2 or 3 in 10 in one of twelve directions.
    Slope,
    /// A floor with blocks of two by two cells, up to two cells high.
    Steps,
    /// A floor one third of whose tiles are pits, up to half a cell deep.
    Rough,
}

impl Setting {
    /// Name as files write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Space => "space",
            Self::Mounted => "mounted",
            Self::Flat => "flat",
            Self::Slope => "slope",
            Self::Steps => "steps",
            Self::Rough => "rough",
        }
    }
}

/// Surroundings, drawn.
#[derive(Clone, Debug)]
pub struct World {
    /// Ground and obstacles.
    pub environment: Environment,
    /// Gravity in m/s^2.
    pub gravity: Vec3,
    /// Cells along x and y that robots grow in: from minus this to this.
    pub reach: i32,
    /// Heights of the blocks in cells, row by row, from -`reach` - `BORDER` on.
    blocks: Vec<Vec<i32>>,
}

impl World {
    /// Draws surroundings of tiles of side `pitch` in m, for robots that reach no farther than `reach` cells from the
    /// origin. The tile (0, 0) begins at (`corner`, `corner`) in m.
    pub fn draw(setting: Setting, pitch: f64, corner: f64, reach: i32, draw: &mut Draw) -> Self {
        let mut world = Self {
            environment: Environment { module_friction: 0.4, ..Environment::default() },
            gravity: Vec3::new(0.0, 0.0, -GRAVITY),
            reach,
            blocks: Vec::new(),
        };
        let floor = |height| Some(Ground { height, friction: FRICTION });
        match setting {
            Setting::Space => world.gravity = Vec3::zeros(),
            Setting::Mounted => {}
            Setting::Flat => world.environment.ground = floor(0.0),
            Setting::Slope => {
                world.environment.ground = floor(0.0);
                world.gravity = tilted(draw);
            }
            Setting::Steps => {
                world.environment.ground = floor(0.0);
                world.add_blocks(pitch, corner, draw);
            }
            Setting::Rough => {
                // Beneath the pits, and where the field ends.
                world.environment.ground = floor(-pitch);
                world.add_pits(pitch, corner, draw);
            }
        }
        world
    }

    /// Height of the ground of a tile in cells.
    pub fn level(&self, x: i32, y: i32) -> i32 {
        let index = |c: i32| usize::try_from((c + self.reach + BORDER).div_euclid(BLOCK)).ok();
        let height = |x, y| self.blocks.get(index(y)?)?.get(index(x)?).copied();
        height(x, y).unwrap_or(0)
    }

    fn add_blocks(&mut self, pitch: f64, corner: f64, draw: &mut Draw) {
        let first = -self.reach - BORDER;
        let count = (2 * (self.reach + BORDER) + 1).div_euclid(BLOCK) + 1;
        for j in 0..count {
            let row: Vec<i32> = (0..count).map(|_| *draw.choose(&STEPS)).collect();
            for (i, &height) in (0..count).zip(&row).filter(|(_, height)| **height > 0) {
                let middle = |k: i32| f64::from(2 * (first + k * BLOCK) + BLOCK) / 2.0 * pitch + corner;
                let half = f64::from(height) * pitch / 2.0;
                let side = f64::from(BLOCK) / 2.0 * pitch;
                self.environment.obstacles.push(Obstacle {
                    shape: Terrain::Solid(Shape::Cuboid { half_extents: Vec3::new(side, side, half) }),
                    pose: at(Vec3::new(middle(i), middle(j), half)),
                    friction: FRICTION,
                });
            }
            self.blocks.push(row);
        }
    }

    /// A height field of two by two squares a tile: what belongs to a tile that is no pit is level.
    fn add_pits(&mut self, pitch: f64, corner: f64, draw: &mut Draw) {
        let first = -self.reach - BORDER;
        let tiles = usize::try_from(1 - 2 * first).expect("a region has tiles");
        let pits: Vec<Vec<bool>> =
            (0..tiles).map(|_| (0..tiles).map(|_| draw.below(ONE_PIT_IN) == 0).collect()).collect();
        // The tiles that a line of heights belongs to along one axis: odd lines run through the middle of one.
        let beside = |line: usize| line.saturating_sub(1) / 2..=(line / 2).min(tiles - 1);
        let mut height = |i: usize, j: usize| {
            let depth = 1 + draw.below(DEPTHS);
            let is_pit = beside(j).all(|y| beside(i).all(|x| pits[y][x]));
            if is_pit { -(depth as f64) * pitch / 20.0 } else { 0.0 }
        };
        let lines = 2 * tiles + 1;
        let heights = (0..lines).map(|j| (0..lines).map(|i| height(i, j)).collect()).collect();
        let field = HeightField::new([pitch / 2.0; 2], heights).expect("a grid of finite heights");
        let origin = f64::from(first) * pitch + corner;
        self.environment.obstacles.push(Obstacle {
            shape: Terrain::HeightField(Arc::new(field)),
            pose: at(Vec3::new(origin, origin, 0.0)),
            friction: FRICTION,
        });
    }
}

/// Gravity on a slope, in the slope's frame. Directions are those with small rational components.
fn tilted(draw: &mut Draw) -> Vec3 {
    let rise = (1 + draw.below(3)) as f64 / 10.0;
    let [along, across] = *draw.choose(&[[1.0, 0.0], [0.6, 0.8], [0.8, 0.6]]);
    let downhill = [[along, across], [-across, along], [-along, -across], [across, -along]][draw.below(4)];
    GRAVITY / (1.0 + rise * rise).sqrt() * Vec3::new(rise * downhill[0], rise * downhill[1], -1.0)
}

fn at(position: Vec3) -> Pose {
    Pose::from_parts(position.into(), crate::spatial::Rotation::identity())
}
