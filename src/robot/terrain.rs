//! Shapes of immovable obstacles.

use std::sync::Arc;

use crate::spatial::Vec3;

use super::shape::{LARGEST, Shape, ShapeFault, within_bounds};

/// Most triangles of a mesh.
pub const MOST_TRIANGLES: usize = 1 << 20;

/// Most heights of a height field: twice as many triangles.
pub const MOST_HEIGHTS: usize = 1 << 19;

/// An obstacle in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Terrain {
    /// A convex solid.
    Solid(Shape),
    /// Everything below z = 0: a slope, a wall or a ceiling, as its pose turns it.
    HalfSpace,
    /// What lies beneath a surface over a rectangular grid.
    HeightField(Arc<HeightField>),
    /// A surface of triangles.
    Mesh(Arc<Mesh>),
}

impl From<Shape> for Terrain {
    fn from(shape: Shape) -> Self {
        Self::Solid(shape)
    }
}

/// Heights over a rectangular grid. Sound by construction.
///
/// Between four neighbouring heights the surface is two triangles that share the
/// diagonal of growing x and y. The ground beneath is solid, down to the longer side of the grid
/// below its lowest height, and ends at the grid's border in vertical walls.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    cell: [f64; 2],
    heights: Vec<Vec<f64>>,
}

impl HeightField {
    /// Heights in m: entry `i` of row `j` is the z at `x = i cell[0]`, `y = j cell[1]`,
    /// so that the frame's origin is a corner of the grid.
    ///
    /// # Errors
    /// Cells without size, less than two rows or columns, rows of unequal length,
    /// too many heights, or what lies beyond [`LARGEST`].
    pub fn new(cell: [f64; 2], heights: Vec<Vec<f64>>) -> Result<Self, ShapeFault> {
        let columns = heights.first().map_or(0, Vec::len);
        if heights.len() < 2 || columns < 2 {
            return Err(ShapeFault::TooFew { least: 2 });
        }
        if let Some(row) = heights.iter().position(|row| row.len() != columns) {
            return Err(ShapeFault::Uneven { row });
        }
        if heights.len().saturating_mul(columns) > MOST_HEIGHTS {
            return Err(ShapeFault::TooMany { most: MOST_HEIGHTS });
        }
        if !cell.iter().all(|side| *side > 0.0) {
            return Err(ShapeFault::NotPositive);
        }
        let far = [cell[0] * (columns - 1) as f64, cell[1] * (heights.len() - 1) as f64];
        if !far.iter().chain(heights.iter().flatten()).all(|c| c.abs() <= LARGEST) {
            return Err(ShapeFault::OutOfBounds);
        }
        Ok(Self { cell, heights })
    }

    /// Distances of neighbouring heights along x and y in m.
    pub fn cell(&self) -> [f64; 2] {
        self.cell
    }

    /// The heights in m, row by row along y.
    pub fn heights(&self) -> &[Vec<f64>] {
        &self.heights
    }
}

/// A surface of triangles. Sound by construction.
///
/// Where every edge belongs to exactly two triangles that run along it in opposite
/// directions, the surface is closed and what it encloses is solid. Any other surface is a
/// sheet without thickness, which can be touched from either side.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Triangles by indices into `vertices` in m. Triangles without area are allowed and carry nothing.
    ///
    /// # Errors
    /// No triangle with an area, too many triangles or vertices, vertices that are not there or
    /// beyond [`LARGEST`].
    pub fn new(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, ShapeFault> {
        if triangles.is_empty() {
            return Err(ShapeFault::TooFew { least: 1 });
        }
        if triangles.len() > MOST_TRIANGLES || vertices.len() > 3 * MOST_TRIANGLES {
            return Err(ShapeFault::TooMany { most: MOST_TRIANGLES });
        }
        if !within_bounds(&vertices) {
            return Err(ShapeFault::OutOfBounds);
        }
        let beyond = |triangle: &[u32; 3]| triangle.iter().any(|&v| v as usize >= vertices.len());
        if let Some(triangle) = triangles.iter().position(beyond) {
            return Err(ShapeFault::NoVertex { triangle });
        }
        let mesh = Self { vertices, triangles };
        let area = |[a, b, c]: [Vec3; 3]| (b - a).cross(&(c - a)).norm();
        let has_area = (0..mesh.triangles.len()).any(|t| area(mesh.corners(t)) > 0.0);
        if has_area { Ok(mesh) } else { Err(ShapeFault::Flat) }
    }

    /// The vertices in m.
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// The triangles, by indices into the vertices.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of a triangle in m.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_that_are_none_are_refused() {
        let field = |cell, rows: &[&[f64]]| HeightField::new(cell, rows.iter().map(|row| row.to_vec()).collect());
        assert!(field([1.0, 2.0], &[&[0.0, 1.0], &[0.0, 0.0]]).is_ok());
        assert_eq!(field([1.0, 1.0], &[&[0.0, 1.0]]), Err(ShapeFault::TooFew { least: 2 }));
        assert_eq!(field([1.0, 1.0], &[&[0.0], &[1.0]]), Err(ShapeFault::TooFew { least: 2 }));
        assert_eq!(field([1.0, 1.0], &[&[0.0, 1.0], &[0.0]]), Err(ShapeFault::Uneven { row: 1 }));
        assert_eq!(field([1.0, 0.0], &[&[0.0, 1.0], &[0.0, 0.0]]), Err(ShapeFault::NotPositive));
        assert_eq!(field([f64::NAN, 1.0], &[&[0.0, 1.0], &[0.0, 0.0]]), Err(ShapeFault::NotPositive));
        assert_eq!(field([2e6, 1.0], &[&[0.0, 1.0], &[0.0, 0.0]]), Err(ShapeFault::OutOfBounds));
        assert_eq!(field([1.0, 1.0], &[&[0.0, f64::NAN], &[0.0, 0.0]]), Err(ShapeFault::OutOfBounds));
        let large = HeightField::new([1.0, 1.0], vec![vec![0.0; 1 << 10]; (1 << 9) + 1]);
        assert_eq!(large, Err(ShapeFault::TooMany { most: MOST_HEIGHTS }));
    }

    #[test]
    fn triangles_that_are_none_are_refused() {
        let corners = vec![Vec3::zeros(), Vec3::x(), Vec3::y()];
        assert!(Mesh::new(corners.clone(), vec![[0, 1, 2], [0, 0, 1]]).is_ok());
        assert_eq!(Mesh::new(corners.clone(), vec![]), Err(ShapeFault::TooFew { least: 1 }));
        assert_eq!(Mesh::new(corners.clone(), vec![[0, 1, 2], [0, 1, 3]]), Err(ShapeFault::NoVertex { triangle: 1 }));
        assert_eq!(Mesh::new(corners.clone(), vec![[0, 1, 1]]), Err(ShapeFault::Flat));
        assert_eq!(Mesh::new(vec![Vec3::repeat(f64::NAN); 3], vec![[0, 1, 2]]), Err(ShapeFault::OutOfBounds));
        let many = vec![[0, 1, 2]; MOST_TRIANGLES + 1];
        assert_eq!(Mesh::new(corners, many), Err(ShapeFault::TooMany { most: MOST_TRIANGLES }));
    }
}
