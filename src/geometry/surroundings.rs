//! Ground and obstacles, prepared for questions about solids among them.

use crate::robot::{Environment, Obstacle, Terrain};
use crate::spatial::Vec3;

use super::broad_phase::BroadPhase;
use super::contact::{ContactPatch, contact, half_space_contact};
use super::figure::Figure;
use super::motion::Motion;
use super::separation::overlap;
use super::solid::Solid;
use super::surface::Surface;
use super::sweep::Mover;

/// Part of an environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Surrounding {
    /// The ground.
    Ground,
    /// The obstacle with this index in [`Environment::obstacles`].
    Obstacle(usize),
}

impl Surrounding {
    /// Friction coefficient of its surface, 0 where the environment has no such part.
    pub fn friction(self, environment: &Environment) -> f64 {
        match self {
            Self::Ground => environment.ground.as_ref().map(|ground| ground.friction),
            Self::Obstacle(index) => environment.obstacles.get(index).map(|obstacle| obstacle.friction),
        }
        .unwrap_or(0.0)
    }
}

/// What surrounds a robot, prepared once for any number of questions.
#[derive(Clone, Debug)]
pub struct Surroundings {
    half_spaces: Vec<(Surrounding, HalfSpace)>,
    solids: BroadPhase,
    /// Which obstacles the solids are.
    solid_obstacles: Vec<usize>,
    surfaces: Vec<(usize, Surface)>,
}

/// Everything below a plane.
#[derive(Clone, Copy, Debug)]
struct HalfSpace {
    /// Unit normal in W, outwards.
    normal: Vec3,
    /// Height of the plane along the normal in m.
    level: f64,
}

impl Surroundings {
    /// Prepares an environment, which must be sound.
    pub fn new(environment: &Environment) -> Self {
        let ground = environment.ground.as_ref();
        let mut half_spaces: Vec<_> = ground
            .map(|ground| (Surrounding::Ground, HalfSpace { normal: Vec3::z(), level: ground.height }))
            .into_iter()
            .collect();
        let (mut solids, mut solid_obstacles, mut surfaces) = (Vec::new(), Vec::new(), Vec::new());
        for (index, Obstacle { shape, pose, .. }) in environment.obstacles.iter().enumerate() {
            match shape {
                Terrain::Solid(shape) => {
                    solids.push(Solid::new(shape.clone(), *pose));
                    solid_obstacles.push(index);
                }
                Terrain::HalfSpace => {
                    let normal = pose.rotation * Vec3::z();
                    let level = normal.dot(&pose.translation.vector);
                    half_spaces.push((Surrounding::Obstacle(index), HalfSpace { normal, level }));
                }
                Terrain::HeightField(field) => surfaces.push((index, Surface::of_height_field(field, pose))),
                Terrain::Mesh(mesh) => surfaces.push((index, Surface::of_mesh(mesh, pose))),
            }
        }
        Self { half_spaces, solids: BroadPhase::new(solids), solid_obstacles, surfaces }
    }

    /// Where a solid touches the surroundings with a gap (or penetration) of at most
    /// `tolerance` in m; normals point into the solid. The ground first, then in the order of the obstacles; a
    /// surface of triangles has a patch for each plane that is touched.
    pub fn contacts(&self, solid: &Solid, tolerance: f64) -> Vec<(Surrounding, ContactPatch)> {
        let planes = self.half_spaces.iter().filter_map(|(what, half_space)| {
            half_space_contact(solid, &half_space.normal, half_space.level, tolerance).map(|patch| (*what, patch))
        });
        let solids = self.solids.near(solid, tolerance).into_iter().filter_map(|(index, other)| {
            contact(solid, other, tolerance).map(|patch| (Surrounding::Obstacle(self.solid_obstacles[index]), patch))
        });
        let surfaces = self.surfaces.iter().flat_map(|(index, surface)| {
            surface.contacts(solid, tolerance).into_iter().map(|patch| (Surrounding::Obstacle(*index), patch))
        });
        let mut found: Vec<_> = planes.chain(solids).chain(surfaces).collect();
        found.sort_by_key(|(what, _)| *what);
        found
    }

    /// The parts that a solid penetrates deeper than `skin` in m or that it is wholly within: the ground, and
    /// the first of the obstacles.
    pub fn overlaps(&self, solid: &Solid, skin: f64) -> Vec<Surrounding> {
        let figure = Figure::new(solid);
        let planes = self.half_spaces.iter().filter(|(_, half_space)| {
            let above = -figure.reach(&-half_space.normal) >= half_space.level - skin;
            !above
        });
        let near = self.solids.near(solid, 0.0);
        let first_solid = near.into_iter().find(|(_, other)| overlap(solid, other, skin));
        let first_surface = self.surfaces.iter().find(|(_, surface)| surface.overlaps(solid, skin));
        let mut found: Vec<_> = planes
            .map(|(what, _)| *what)
            .chain(first_solid.map(|(index, _)| Surrounding::Obstacle(self.solid_obstacles[index])))
            .chain(first_surface.map(|(index, _)| Surrounding::Obstacle(*index)))
            .collect();
        found.sort_unstable();
        // Of the obstacles, which come after the ground, the first.
        found.dedup_by_key(|what| *what == Surrounding::Ground);
        found
    }

    /// The first thing that a solid hits on its way, with the smallest phase in 0 to 1, or `None` when
    /// the way is free; the first in order of those hit at once. With the guarantees of [`first_collision`](super::first_collision) towards each part
    /// and each triangle; a solid that starts wholly within a closed surface hits it at once.
    pub fn first_collision(&self, solid: &Solid, motion: &Motion) -> Option<(f64, Surrounding)> {
        let mover = Mover::new(solid, motion);
        let mut first: Option<(f64, Surrounding)> = None;
        let mut note = |what: Surrounding, hit: &dyn Fn(f64) -> Option<f64>| {
            let until = first.map_or(1.0, |(phase, _)| phase);
            if let Some(phase) = hit(until)
                && first.is_none_or(|known| (phase, what) < known)
            {
                first = Some((phase, what));
            }
        };
        for (what, HalfSpace { normal, level }) in &self.half_spaces {
            note(*what, &|until| mover.hits_plane(normal, *level, until));
        }
        let (low, high) = mover.bounds();
        for (index, other) in self.solids.in_box(&low, &high) {
            note(Surrounding::Obstacle(self.solid_obstacles[index]), &|until| mover.hits_solid(other, until));
        }
        for (index, surface) in &self.surfaces {
            let what = Surrounding::Obstacle(*index);
            if surface.holds(mover.start()) {
                note(what, &|_| Some(0.0));
            }
            for triangle in surface.near(&low, &high, 0.0) {
                let figure = surface.triangles[triangle].figure();
                note(what, &|until| mover.hits_figure(&figure, until));
            }
        }
        first
    }

    /// Whether something may reach into the bounding box of a solid: `false` is sure.
    pub fn may_touch(&self, solid: &Solid) -> bool {
        let (low, high) = solid.bounds();
        let figure = Figure::new(solid);
        self.half_spaces.iter().any(|(_, half_space)| -figure.reach(&-half_space.normal) <= half_space.level)
            || !self.solids.near(solid, 0.0).is_empty()
            || self
                .surfaces
                .iter()
                .any(|(_, surface)| !surface.near(&low, &high, 0.0).is_empty() || surface.holds(solid))
    }
}
