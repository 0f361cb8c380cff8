//! Where a link acts: the frame of its force and the two sides it acts on.

use nalgebra::Matrix3;

use crate::spatial::{Twist, Vec3, Wrench};

use super::blocks::{Link, Vertex, ends};
use super::structure::Structure;

/// The frame of a connection or contact, and whom its wrench acts on.
#[derive(Clone, Debug)]
pub(super) struct LinkFrame {
    /// The child, or the body that a contact's normal points into: gets the wrench.
    pub plus: Vertex,
    /// The other side: gets the opposite wrench.
    pub minus: Vertex,
    /// Origin in W, in m.
    pub origin: Vec3,
    /// Columns are the frame's axes in W.
    pub axes: Matrix3<f64>,
}

impl LinkFrame {
    pub(super) fn new(structure: &Structure, link: Link) -> Self {
        let [a, b] = ends(structure, link);
        let (origin, axes) = placed(structure, link);
        match link {
            Link::Connection(_) => Self { plus: b, minus: a, origin, axes },
            Link::Contact(_) => Self { plus: a, minus: b, origin, axes },
        }
    }

    /// The two sides with the sign of the wrench that each gets.
    pub(super) fn sides(&self) -> [(Vertex, f64); 2] {
        [(self.plus, 1.0), (self.minus, -1.0)]
    }

    /// A wrench in the frame as one in W, still about the frame's origin.
    pub(super) fn in_world(&self, local: &Wrench) -> Wrench {
        Wrench::new(self.axes * local.force, self.axes * local.torque)
    }

    /// Twist of the plus side relative to the minus side at the origin, in the
    /// frame. `twist` gives a body's twist at its centre of mass in W.
    pub(super) fn relative_twist(&self, structure: &Structure, twist: impl Fn(usize) -> Twist) -> Twist {
        let here = |vertex: Vertex| match vertex {
            Vertex::Body(i) => Some(twist(i).moved(&(self.origin - structure.bodies[i].com))),
            Vertex::Ground => None,
        };
        self.apart([here(self.plus), here(self.minus)])
    }

    /// Twist of the plus side relative to the minus side, in the frame, of their twists at the
    /// origin in W; `None` rests.
    pub(super) fn apart(&self, [plus, minus]: [Option<Twist>; 2]) -> Twist {
        let mut relative = plus.unwrap_or(Twist::ZERO);
        if let Some(minus) = minus {
            relative.linear -= minus.linear;
            relative.angular -= minus.angular;
        }
        Twist::new(self.axes.tr_mul(&relative.linear), self.axes.tr_mul(&relative.angular))
    }
}

/// Origin and axes of a link's frame.
pub(super) fn placed(structure: &Structure, link: Link) -> (Vec3, Matrix3<f64>) {
    match link {
        Link::Connection(i) => {
            let frame = &structure.connections[i].frame;
            (frame.translation.vector, *frame.rotation.to_rotation_matrix().matrix())
        }
        Link::Contact(i) => {
            let contact = &structure.contacts[i];
            (contact.position, axes_along(&contact.normal.normalize()))
        }
    }
}

/// Orthonormal right-handed axes with `z` as the third.
fn axes_along(z: &Vec3) -> Matrix3<f64> {
    let helper = if z.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let y = z.cross(&helper).normalize();
    Matrix3::from_columns(&[y.cross(z), y, *z])
}
