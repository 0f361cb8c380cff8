//! Integer placements in the cubic lattice, from which poses are derived: a
//! plan run forwards and backwards returns the identical state.

use nalgebra::{Matrix3, Rotation3, Translation3};

use crate::spatial::{Pose, Rotation, Vec3};

/// A lattice cell: it fills `[x, x+1] x [y, y+1] x [z, z+1]` times the pitch.
pub type Cell = [i32; 3];

/// One of the six faces of a cube, by its outward normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Face {
    /// Normal -x.
    NegX,
    /// Normal +x.
    PosX,
    /// Normal -y.
    NegY,
    /// Normal +y.
    PosY,
    /// Normal -z.
    NegZ,
    /// Normal +z.
    PosZ,
}

impl Face {
    /// All faces, in the order used everywhere.
    pub const ALL: [Self; 6] = [Self::NegX, Self::PosX, Self::NegY, Self::PosY, Self::NegZ, Self::PosZ];

    /// Outward normal, as a step to the neighbouring cell.
    pub const fn step(self) -> Cell {
        match self {
            Self::NegX => [-1, 0, 0],
            Self::PosX => [1, 0, 0],
            Self::NegY => [0, -1, 0],
            Self::PosY => [0, 1, 0],
            Self::NegZ => [0, 0, -1],
            Self::PosZ => [0, 0, 1],
        }
    }

    /// The face with this outward normal, if it is a unit step.
    pub fn from_step(step: Cell) -> Option<Self> {
        Self::ALL.into_iter().find(|face| face.step() == step)
    }

    /// The face on the other side.
    #[must_use]
    pub const fn opposite(self) -> Self {
        match self {
            Self::NegX => Self::PosX,
            Self::PosX => Self::NegX,
            Self::NegY => Self::PosY,
            Self::PosY => Self::NegY,
            Self::NegZ => Self::PosZ,
            Self::PosZ => Self::NegZ,
        }
    }

    /// Outward normal as a unit vector.
    pub fn normal(self) -> Vec3 {
        Vec3::from(self.step().map(f64::from))
    }

    /// Axes of a frame on this face: z outwards, x along the axis after the normal's (in the
    /// order x, y, z, x).
    pub fn outward_frame(self) -> Rotation {
        let z = self.normal();
        let x = Vec3::ith((self.axis() + 1) % 3, 1.0);
        Rotation::from_rotation_matrix(&Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z])))
    }

    /// Index of the axis it is perpendicular to: 0 for x, 1 for y, 2 for z.
    pub const fn axis(self) -> usize {
        match self {
            Self::NegX | Self::PosX => 0,
            Self::NegY | Self::PosY => 1,
            Self::NegZ | Self::PosZ => 2,
        }
    }

    /// Name as files write it, e.g. `+x`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NegX => "-x",
            Self::PosX => "+x",
            Self::NegY => "-y",
            Self::PosY => "+y",
            Self::NegZ => "-z",
            Self::PosZ => "+z",
        }
    }

    /// The face that files call `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|face| face.name() == name)
    }
}

/// One of the 24 rotations of a cube, as an integer matrix of the module's
/// axes in the world: column j is where the module's axis j points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Orientation([[i8; 3]; 3]);

impl Orientation {
    /// Module axes along the world axes.
    pub const IDENTITY: Self = Self([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);

    /// The rows of the rotation matrix.
    pub const fn rows(self) -> [[i8; 3]; 3] {
        self.0
    }

    /// The quarter turn about the outward normal of `axis`, right-handed.
    pub fn quarter_turn(axis: Face) -> Self {
        let [x, y, z] = axis.step().map(|s| s as i8);
        // R = n n^T + [n]_x for a turn of 90 degrees about the unit vector n.
        Self([[x * x, x * y - z, x * z + y], [y * x + z, y * y, y * z - x], [z * x - y, z * y + x, z * z]])
    }

    /// This orientation turned further by `turn`, about world axes.
    #[must_use]
    pub fn turned(self, turn: Self) -> Self {
        let (a, b) = (turn.0, self.0);
        Self(std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum())))
    }

    /// All 24, in a fixed order.
    pub fn all() -> impl Iterator<Item = Self> {
        let columns = |x: Face, y: Face| {
            let (a, b) = (x.step(), y.step());
            let z: Cell = std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
            Self(std::array::from_fn(|i| [a[i] as i8, b[i] as i8, z[i] as i8]))
        };
        let pairs = Face::ALL.into_iter().flat_map(|x| Face::ALL.map(|y| (x, y)));
        pairs.filter(|(x, y)| x.axis() != y.axis()).map(move |(x, y)| columns(x, y))
    }

    /// Where it takes a cell that is counted from the module's own.
    pub fn carry(self, cell: Cell) -> Cell {
        std::array::from_fn(|i| (0..3).map(|k| i32::from(self.0[i][k]) * cell[k]).sum())
    }

    /// The same rotation as a unit quaternion.
    pub fn rotation(self) -> Rotation {
        let matrix = Matrix3::from_fn(|i, j| f64::from(self.0[i][j]));
        Rotation::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix))
    }

    /// The world direction that the module's face points in.
    pub fn to_world(self, face: Face) -> Face {
        Face::from_step(self.carry(face.step())).expect("a signed permutation keeps unit steps")
    }

    /// The module's face that points in this world direction.
    pub fn to_module(self, world: Face) -> Face {
        Face::ALL.into_iter().find(|&face| self.to_world(face) == world).expect("a rotation is a bijection")
    }
}

/// Where a lattice module is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Placement {
    /// Its cell.
    pub cell: Cell,
    /// How it is turned.
    pub orientation: Orientation,
}

impl Placement {
    /// In this cell, with the module's axes along the world's.
    pub const fn new(cell: Cell) -> Self {
        Self { cell, orientation: Orientation::IDENTITY }
    }

    /// Pose of the module frame in W, for cells of edge length `pitch` in m:
    /// the origin is the centre of the cube.
    pub fn pose(&self, pitch: f64) -> Pose {
        Pose::from_parts(Translation3::from(self.centre(pitch)), self.orientation.rotation())
    }

    /// Centre of the cell in W, in m.
    pub fn centre(&self, pitch: f64) -> Vec3 {
        Vec3::from(self.cell.map(|c| (f64::from(c) + 0.5) * pitch))
    }
}

/// The cell one step beyond a face of `cell`; `None` where the coordinates overflow.
pub fn neighbour(cell: Cell, face: Face) -> Option<Cell> {
    let step = face.step();
    Some([cell[0].checked_add(step[0])?, cell[1].checked_add(step[1])?, cell[2].checked_add(step[2])?])
}
