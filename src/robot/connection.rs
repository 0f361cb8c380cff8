//! Two ports that hold each other, whatever the family of the robot calls a port.

/// A place where a connector engages, on a module.
pub trait OnModule {
    /// Index of its module.
    fn module(&self) -> usize;
}

/// An engaged connection between two ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Connection<P> {
    /// The two ports, the smaller one first: the parent of the connection's frame.
    pub ports: [P; 2],
}

impl<P: OnModule + Ord> Connection<P> {
    /// A connection between two ports, in either order.
    pub fn new(a: P, b: P) -> Self {
        Self { ports: if a <= b { [a, b] } else { [b, a] } }
    }

    /// The two modules, in the order of the ports.
    pub fn modules(&self) -> [usize; 2] {
        self.ports.each_ref().map(P::module)
    }
}
