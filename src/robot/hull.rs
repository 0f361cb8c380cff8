//! Convex hulls of points.

use std::collections::BTreeMap;

use crate::spatial::Vec3;

use super::shape::{ShapeFault, within_bounds};

/// Most points that a hull is made of: all triples of them are looked at.
const MOST_POINTS: usize = 256;

/// Distance from a plane, relative to the size of the hull, up to which a point
/// counts as in it: a thousand times the rounding of the plane.
const IN_PLANE: f64 = 1e-12;

/// Decimal input can say no more than this of directions: normals and edges
/// closer than that are one.
const SAME_DIRECTION: f64 = 1e-9;

/// The convex hull of points, with its faces. Sound by construction.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    points: Vec<Vec3>,
    corners: Vec<Vec3>,
    faces: Vec<HullFace>,
    edges: Vec<Vec3>,
    centre: Vec3,
    inner_radius: f64,
}

/// A face of a hull: the half-space `normal . p <= offset` holds all of it.
#[derive(Clone, Debug, PartialEq)]
pub struct HullFace {
    /// Outward unit normal.
    pub normal: Vec3,
    /// Distance of the face's plane from the origin along the normal, in m.
    pub offset: f64,
}

impl Hull {
    /// The hull of at least four points that do not lie in a plane.
    ///
    /// # Errors
    /// Points that are too few, too many (256), too far, or all in a plane.
    pub fn new(points: Vec<Vec3>) -> Result<Self, ShapeFault> {
        if points.len() < 4 {
            return Err(ShapeFault::TooFew { least: 4 });
        }
        if points.len() > MOST_POINTS {
            return Err(ShapeFault::TooMany { most: MOST_POINTS });
        }
        if !within_bounds(&points) {
            return Err(ShapeFault::OutOfBounds);
        }
        let mut corners: Vec<Vec3> = Vec::with_capacity(points.len());
        for point in &points {
            if !corners.contains(point) {
                corners.push(*point);
            }
        }
        if corners.len() < 4 {
            return Err(ShapeFault::Flat);
        }
        let mean = corners.iter().sum::<Vec3>() / corners.len() as f64;
        let size = corners.iter().map(|p| (p - mean).norm()).fold(0.0, f64::max);
        let tolerance = IN_PLANE * size.max(mean.norm());
        let found = faces(&corners, tolerance, size);
        // Points of one plane have two faces, of one line none.
        if found.len() < 4 {
            return Err(ShapeFault::Flat);
        }
        let on = |face: &HullFace, p: &Vec3| face.normal.dot(p) >= face.offset - tolerance;
        corners.retain(|p| found.iter().filter(|face| on(face, p)).count() >= 3);
        let centre = corners.iter().sum::<Vec3>() / corners.len() as f64;
        let inner_radius =
            found.iter().map(|face| face.offset - face.normal.dot(&centre)).fold(f64::INFINITY, f64::min);
        if !(inner_radius > tolerance) {
            return Err(ShapeFault::Flat);
        }
        let edges = edges(&corners, &found, on);
        Ok(Self { points, corners, faces: found, edges, centre, inner_radius })
    }

    /// The points that it was made of, in m.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Its corners in m, in the order of the points.
    pub fn corners(&self) -> &[Vec3] {
        &self.corners
    }

    /// Its faces.
    pub fn faces(&self) -> &[HullFace] {
        &self.faces
    }

    /// The directions of its edges, unit length, each line once.
    pub fn edges(&self) -> &[Vec3] {
        &self.edges
    }

    /// A point inside: the mean of its corners, in m.
    pub fn centre(&self) -> Vec3 {
        self.centre
    }

    /// The same with all distances from its [centre](Self::centre) multiplied by `share`, above 0.
    #[must_use]
    pub fn scaled(&self, share: f64) -> Self {
        let scaled = |p: &Vec3| self.centre + (p - self.centre) * share;
        let mut hull = self.clone();
        hull.points.iter_mut().chain(&mut hull.corners).for_each(|p| *p = scaled(p));
        for face in &mut hull.faces {
            let level = face.normal.dot(&self.centre);
            face.offset = level + (face.offset - level) * share;
        }
        hull.inner_radius *= share;
        hull
    }

    /// Distance from the [centre](Self::centre) to the nearest face, in m.
    pub fn inner_radius(&self) -> f64 {
        self.inner_radius
    }
}

/// The planes through three points that have all points on one side, each once.
fn faces(points: &[Vec3], tolerance: f64, size: f64) -> Vec<HullFace> {
    let mut faces: Vec<HullFace> = Vec::new();
    for (i, a) in points.iter().enumerate() {
        for (j, b) in points.iter().enumerate().skip(i + 1) {
            for c in &points[j + 1..] {
                let cross = (b - a).cross(&(c - a));
                if !(cross.norm() > SAME_DIRECTION * size * size) {
                    continue;
                }
                let normal = cross.normalize();
                let (mut above, mut below) = (false, false);
                for p in points {
                    let height = normal.dot(&(p - a));
                    above |= height > tolerance;
                    below |= height < -tolerance;
                    if above && below {
                        break;
                    }
                }
                if above && below {
                    continue;
                }
                let normal = if above { -normal } else { normal };
                let known = |face: &HullFace| (face.normal - normal).norm() <= SAME_DIRECTION;
                if !faces.iter().any(known) {
                    let offset = points.iter().map(|p| normal.dot(p)).fold(f64::NEG_INFINITY, f64::max);
                    faces.push(HullFace { normal, offset });
                }
            }
        }
    }
    faces
}

/// Directions of the edges: lines through two corners that share two faces.
fn edges(corners: &[Vec3], faces: &[HullFace], on: impl Fn(&HullFace, &Vec3) -> bool) -> Vec<Vec3> {
    let mut ends: BTreeMap<[usize; 2], Vec<&Vec3>> = BTreeMap::new();
    for corner in corners {
        let own: Vec<usize> = (0..faces.len()).filter(|&f| on(&faces[f], corner)).collect();
        for (i, &f) in own.iter().enumerate() {
            for &g in &own[i + 1..] {
                ends.entry([f, g]).or_default().push(corner);
            }
        }
    }
    let mut directions: Vec<Vec3> = Vec::new();
    for corners in ends.values().filter(|corners| corners.len() >= 2) {
        let direction = (corners[1] - corners[0]).normalize();
        if !directions.iter().any(|known| known.cross(&direction).norm() <= SAME_DIRECTION) {
            directions.push(direction);
        }
    }
    directions
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn cube() -> Vec<Vec3> {
        let c = |i: usize, bit: usize| if i & bit == 0 { -0.5 } else { 0.5 };
        (0..8).map(|i| Vec3::new(c(i, 1), c(i, 2), c(i, 4))).collect()
    }

    #[test]
    fn points_inside_and_on_the_faces_of_a_cube_change_nothing() {
        let mut points = cube();
        let plain = Hull::new(points.clone()).unwrap();
        assert_eq!((plain.corners().len(), plain.faces().len(), plain.edges().len()), (8, 6, 3));
        assert_eq!((plain.centre(), plain.inner_radius()), (Vec3::zeros(), 0.5));
        points.extend([Vec3::zeros(), Vec3::new(0.5, 0.1, 0.0), Vec3::new(0.5, 0.5, 0.0), Vec3::repeat(0.5)]);
        let same = Hull::new(points).unwrap();
        assert_eq!((same.corners(), same.faces().len(), same.edges().len()), (plain.corners(), 6, 3));
    }

    #[test]
    fn what_has_no_volume_is_no_hull() {
        let flat = |n: usize| (0..n).map(|i| Vec3::new((i * i) as f64, i as f64, 1.0)).collect::<Vec<_>>();
        assert_eq!(Hull::new(flat(6)), Err(ShapeFault::Flat));
        assert_eq!(Hull::new(flat(3)), Err(ShapeFault::TooFew { least: 4 }));
        assert_eq!(Hull::new(flat(257)), Err(ShapeFault::TooMany { most: 256 }));
        assert_eq!(Hull::new(vec![Vec3::x(); 4]), Err(ShapeFault::Flat));
        assert_eq!(Hull::new((0..5).map(|i| Vec3::repeat(f64::from(i))).collect()), Err(ShapeFault::Flat));
        for far in [f64::NAN, f64::INFINITY, 1e7] {
            let mut points = cube();
            points[3].y = far;
            assert_eq!(Hull::new(points), Err(ShapeFault::OutOfBounds));
        }
    }

    proptest! {
        #[test]
        fn a_hull_obeys_euler_and_holds_its_points(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0), 4..20)) {
            let hull = Hull::new(points.into_iter().map(Vec3::from).collect()).unwrap();
            for p in hull.points() {
                prop_assert!(hull.faces().iter().all(|f| f.normal.dot(p) <= f.offset + 1e-12));
            }
            // Random points have triangular faces: E = 3/2 F, and V - E + F = 2.
            let (v, f) = (hull.corners().len(), hull.faces().len());
            prop_assert_eq!(2 * v, f + 4);
            prop_assert_eq!(2 * hull.edges().len(), 3 * f);
        }
    }
}
