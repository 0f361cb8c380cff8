//! Shapes of immovable obstacles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{Positive, Real};

/// An obstacle in its own frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Terrain {
    /// A box.
    Cuboid {
        /// Half of the edge lengths along x, y and z.
        half_extents_m: [Positive; 3],
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius.
        radius_m: Positive,
        /// Height.
        height_m: Positive,
    },
    /// A ball.
    Ball {
        /// Radius.
        radius_m: Positive,
    },
    /// The convex hull of points.
    Convex {
        /// At least four points that do not lie in a plane.
        #[schemars(length(min = 4, max = 256))]
        points_m: Vec<[Real; 3]>,
    },
    /// Everything below z = 0: a slope, a wall or a ceiling, as its rotation turns it.
    Plane {},
    /// Heights over a grid, solid beneath down to the longer side of the grid below the lowest height.
    HeightField {
        /// Distances of neighbouring heights along x and y.
        cell_m: [Positive; 2],
        /// Rows along y of heights along x; the first one is at the origin.
        #[schemars(length(min = 2), inner(length(min = 2)))]
        heights_m: Vec<Vec<Real>>,
    },
    /// Triangles, from a file or listed. Where they enclose a room, it is solid; otherwise they
    /// are a sheet that can be touched from either side.
    Mesh(Mesh),
}

/// Triangles: either `file`, or `vertices_m` and `triangles`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mesh {
    /// Path of an STL or OBJ file, relative to this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) file: Option<String>,
    /// What the file's lengths are multiplied by, e.g. 0.001 for millimetres, by default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) scale: Option<Positive>,
    /// The vertices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) vertices_m: Option<Vec<[Real; 3]>>,
    /// The triangles, each by the indices of its vertices, counter-clockwise seen from outside.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub(crate) triangles: Option<Vec<[u32; 3]>>,
}
