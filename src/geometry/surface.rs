//! Surfaces of triangles in W: meshes and height fields, prepared for questions.

use std::collections::HashMap;

use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

use crate::robot::{HeightField, Mesh};
use crate::spatial::{Point, Pose, Vec3};

use super::broad_phase::{aabb, indices_in};
use super::figure::Figure;
use super::separation::of_figures;
use super::solid::Solid;
use super::tolerances::{SAME_NORMAL, SKIN};

/// A surface of triangles.
///
/// A closed one bounds a solid: its triangles are touched from outside only, and what
/// lies within is in collision. Any other is a sheet without thickness, touched
/// from either side.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub triangles: Vec<Triangle>,
    pub is_closed: bool,
    /// z of its highest corner in m.
    top: f64,
    tree: Bvh,
}

/// A triangle with an area.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    /// Corners in W, in m, counter-clockwise seen from where the normal points.
    pub corners: [Vec3; 3],
    /// Unit normal in W, outwards where the surface is closed.
    pub normal: Vec3,
    /// How the surface goes on beyond the edges from corners 0, 1 and 2 to the next.
    pub bends: [Bend; 3],
}

/// How a surface goes on beyond an edge of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bend {
    /// It ends, or no one triangle can be told.
    Border,
    /// It falls away from where the triangle's normal points.
    Ridge,
    /// It rises to where the triangle's normal points.
    Valley,
    /// In the same plane.
    Flat,
}

impl Bend {
    /// Whether there is nothing in the triangle's plane or above it beyond the edge, seen
    /// from the side that the normal points to, or from the other one.
    pub fn is_exposed(self, from_front: bool) -> bool {
        match self {
            Self::Border => true,
            Self::Ridge => from_front,
            Self::Valley => !from_front,
            Self::Flat => false,
        }
    }
}

impl Triangle {
    /// Its figure.
    pub fn figure(&self) -> Figure {
        Figure::triangle(self.corners, self.normal)
    }
}

impl Surface {
    /// A mesh at a pose.
    pub fn of_mesh(mesh: &Mesh, pose: &Pose) -> Self {
        Self::new(mesh.vertices(), mesh.triangles().to_vec(), pose)
    }

    /// A height field at a pose, with its walls and its floor.
    pub fn of_height_field(field: &HeightField, pose: &Pose) -> Self {
        let (vertices, triangles) = block(field);
        Self::new(&vertices, triangles, pose)
    }

    fn new(vertices: &[Vec3], triangles: Vec<[u32; 3]>, pose: &Pose) -> Self {
        let mut triangles = welded(vertices, triangles);
        let edges = Edges::new(&triangles);
        let is_closed = edges.are_closed();
        let corners = |triangle: &[u32; 3]| triangle.map(|v| vertices[v as usize]);
        let origin = vertices.first().copied().unwrap_or_default();
        let volume = |triangle: &[u32; 3]| {
            let [a, b, c] = corners(triangle).map(|p| p - origin);
            a.dot(&b.cross(&c))
        };
        let is_inside_out = is_closed && triangles.iter().map(volume).sum::<f64>() < 0.0;
        let bends: Vec<[Bend; 3]> =
            (0..triangles.len()).map(|t| edges.bends(&triangles, t, vertices, is_inside_out)).collect();
        let mut kept = Vec::with_capacity(triangles.len());
        for (triangle, mut bends) in triangles.iter_mut().zip(bends) {
            if is_inside_out {
                triangle.swap(1, 2);
                bends.swap(0, 2);
            }
            let corners = corners(triangle).map(|p| (pose * Point::from(p)).coords);
            let Some(normal) = normal_of(&corners) else { continue };
            kept.push(Triangle { corners, normal, bends });
        }
        let boxes: Vec<_> = kept
            .iter()
            .map(|t| {
                let [a, b, c] = t.corners;
                aabb(&a.inf(&b).inf(&c), &a.sup(&b).sup(&c), 0.0)
            })
            .collect();
        let top = kept.iter().flat_map(|t| t.corners).map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
        Self { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes), triangles: kept, is_closed, top }
    }

    /// Indices of the triangles whose bounding boxes come within `margin` in m of a box's, ascending.
    pub fn near(&self, low: &Vec3, high: &Vec3, margin: f64) -> Vec<usize> {
        indices_in(&self.tree, &aabb(low, high, margin))
    }

    /// Whether a solid reaches deeper than `skin` in m through the surface, or lies within it.
    pub fn overlaps(&self, solid: &Solid, skin: f64) -> bool {
        let figure = Figure::new(solid);
        let (low, high) = solid.bounds();
        let core = SKIN * solid.size();
        let crosses = |&index: &usize| {
            let triangle = self.triangles[index].figure();
            !of_figures(&figure, &triangle, core).iter().any(|s| s.gap >= -skin)
        };
        self.near(&low, &high, 0.0).iter().any(crosses) || self.holds(solid)
    }

    /// Whether a solid that does not cross the surface lies within it: an upright ray from a point of it leaves
    /// what is closed through an odd number of triangles.
    pub fn holds(&self, solid: &Solid) -> bool {
        if !self.is_closed {
            return false;
        }
        // A little off the centre, which symmetric figures share with corners and edges.
        let from = solid.centre() + Vec3::new(0.414, -0.267, 0.139) * (SKIN * solid.size());
        let top = Vec3::new(from.x, from.y, self.top.max(from.z));
        let crossed = |&index: &usize| height_over(&self.triangles[index].corners, &from).is_some_and(|z| z > from.z);
        self.near(&from, &top, 0.0).iter().filter(|index| crossed(index)).count() % 2 == 1
    }
}

/// Height of the triangle in the upright line through a point.
fn height_over(corners: &[Vec3; 3], p: &Vec3) -> Option<f64> {
    let flat = |v: &Vec3| v.xy() - p.xy();
    let [a, b, c] = corners.each_ref().map(flat);
    let weights = [b.perp(&c), c.perp(&a), a.perp(&b)];
    let inside = weights.iter().all(|w| *w > 0.0) || weights.iter().all(|w| *w < 0.0);
    let total: f64 = weights.iter().sum();
    inside.then(|| corners.iter().zip(weights).map(|(v, w)| v.z * w).sum::<f64>() / total)
}

fn normal_of([a, b, c]: &[Vec3; 3]) -> Option<Vec3> {
    let (u, v) = (b - a, c - a);
    let cross = u.cross(&v);
    // A sliver's normal is rounding.
    (cross.norm() > 1e-12 * u.norm_squared().max(v.norm_squared())).then(|| cross.normalize())
}

/// The triangles with equal vertices made one, without those that have an edge of no length.
fn welded(vertices: &[Vec3], triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let mut first: HashMap<[u64; 3], u32> = HashMap::with_capacity(vertices.len());
    // Adding zero makes one of both zeros.
    let bits = |p: &Vec3| [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits());
    let same: Vec<u32> = (0..).zip(vertices).map(|(v, p)| *first.entry(bits(p)).or_insert(v)).collect();
    let welded = triangles.into_iter().map(|triangle| triangle.map(|v| same[v as usize]));
    welded.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// Which triangles run along each directed edge.
struct Edges {
    first: HashMap<[u32; 2], usize>,
    /// Whether some directed edge has more than one triangle.
    crowded: bool,
}

impl Edges {
    fn new(triangles: &[[u32; 3]]) -> Self {
        let mut edges = Self { first: HashMap::with_capacity(3 * triangles.len()), crowded: false };
        for (t, triangle) in triangles.iter().enumerate() {
            for i in 0..3 {
                edges.crowded |= edges.first.insert([triangle[i], triangle[(i + 1) % 3]], t).is_some();
            }
        }
        edges
    }

    /// Whether every edge has two triangles that run along it in opposite directions.
    fn are_closed(&self) -> bool {
        !self.crowded && self.first.keys().all(|&[a, b]| self.first.contains_key(&[b, a]))
    }

    fn bends(&self, triangles: &[[u32; 3]], t: usize, vertices: &[Vec3], is_inside_out: bool) -> [Bend; 3] {
        let triangle = triangles[t];
        let at = |v: u32| vertices[v as usize];
        let normal = normal_of(&triangle.map(at)).map(|n| if is_inside_out { -n } else { n });
        let bend = |i: usize| {
            let (from, to) = (triangle[i], triangle[(i + 1) % 3]);
            let (Some(normal), Some(&other)) = (normal, self.first.get(&[to, from])) else { return Bend::Border };
            let apex = triangles[other].iter().find(|&&v| v != from && v != to);
            let Some(beyond) = apex.map(|&v| at(v) - at(from)) else { return Bend::Border };
            let along = (at(to) - at(from)).normalize();
            let away = (beyond - along * along.dot(&beyond)).norm();
            match normal.dot(&beyond) {
                height if height > SAME_NORMAL * away => Bend::Valley,
                height if height < -SAME_NORMAL * away => Bend::Ridge,
                _ => Bend::Flat,
            }
        };
        [0, 1, 2].map(bend)
    }
}

/// The solid beneath a height field: its surface, its walls and its floor, outwards.
fn block(field: &HeightField) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (cell, heights) = (field.cell(), field.heights());
    let (rows, columns) = (heights.len(), heights[0].len());
    let (width, length) = (cell[0] * (columns - 1) as f64, cell[1] * (rows - 1) as f64);
    let lowest = heights.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let floor = lowest - width.max(length);
    let at = |row: usize, column: usize| (row * columns + column) as u32;
    let mut vertices = Vec::with_capacity(rows * columns + 2 * (rows + columns));
    for (j, row) in heights.iter().enumerate() {
        vertices.extend(row.iter().enumerate().map(|(i, &z)| Vec3::new(i as f64 * cell[0], j as f64 * cell[1], z)));
    }
    let mut triangles = Vec::with_capacity(2 * rows * columns + 6 * (rows + columns));
    for j in 0..rows - 1 {
        for i in 0..columns - 1 {
            let [a, b, c, d] = [at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    // The border, in the order in which the surface runs along it.
    let south = (0..columns - 1).map(|i| at(0, i));
    let east = (0..rows - 1).map(|j| at(j, columns - 1));
    let north = (1..columns).rev().map(|i| at(rows - 1, i));
    let west = (1..rows).rev().map(|j| at(j, 0));
    let border: Vec<u32> = south.chain(east).chain(north).chain(west).collect();
    let beneath = |i: usize| (rows * columns + i % border.len()) as u32;
    for &top in &border {
        let above: Vec3 = vertices[top as usize];
        vertices.push(Vec3::new(above.x, above.y, floor));
    }
    let middle = vertices.len() as u32;
    vertices.push(Vec3::new(width / 2.0, length / 2.0, floor));
    for (i, &from) in border.iter().enumerate() {
        let to = border[(i + 1) % border.len()];
        let (from_floor, to_floor) = (beneath(i), beneath(i + 1));
        triangles.extend([[to, from, from_floor], [to, from_floor, to_floor], [to_floor, from_floor, middle]]);
    }
    (vertices, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_height_field_is_a_closed_block_of_the_volume_beneath_it() {
        let field = HeightField::new([0.5, 2.0], vec![vec![0.0, 1.0, 0.0], vec![1.0, 3.0, 1.0]]).unwrap();
        let surface = Surface::of_height_field(&field, &Pose::identity());
        assert!(surface.is_closed);
        let volume: f64 =
            surface.triangles.iter().map(|t| t.corners[0].dot(&t.corners[1].cross(&t.corners[2])) / 6.0).sum();
        // Floor at -2 under 1 m x 2 m; half a square metre for each triangle, times the mean of its heights.
        let surface_volume =
            0.5 * ((0.0 + 1.0 + 3.0) + (0.0 + 3.0 + 1.0) + (1.0 + 0.0 + 1.0) + (1.0 + 1.0 + 3.0)) / 3.0;
        assert!((volume - (4.0 + surface_volume)).abs() < 1e-12, "{volume}");
    }

    #[test]
    fn a_surface_bends_where_it_has_an_edge() {
        use Bend::{Border, Flat, Ridge, Valley};
        // A roof along y, its two sides; the outer edges are borders.
        let roof = |height: f64| {
            let corner = |i: usize| Vec3::new((i % 3) as f64, (i / 3) as f64, if i % 3 == 1 { height } else { 0.0 });
            let triangles = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
            let mesh = Mesh::new((0..6).map(corner).collect(), triangles).unwrap();
            Surface::of_mesh(&mesh, &Pose::identity()).triangles.iter().map(|t| t.bends).collect::<Vec<_>>()
        };
        for (height, middle) in [(0.0, Flat), (1.0, Ridge), (-1.0, Valley)] {
            let expected =
                [[Border, middle, Flat], [Flat, Border, Border], [Border, Border, Flat], [Flat, Border, middle]];
            assert_eq!(roof(height), expected);
        }
    }
}
