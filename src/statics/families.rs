//! The elements of a block's program, sorted by size: the compiler unrolls what it
//! does with each.
//!
//! Knows elements of one size, nothing of what holds for all of them together.

use super::element::{Element, End, Rows};
use super::groups::Cone;
use super::network::Network;
use super::parts::Part;
use super::stiffness::Matrix;

/// All elements of one size.
pub(super) struct Family<const D: usize, const N: usize> {
    pub elements: Vec<Element<D, N>>,
    /// Per element its first variable.
    first: Vec<usize>,
    /// Per element its constant part of the stiffness; empty for single variables.
    reflected: Vec<[Matrix<D>; 3]>,
}

impl<const D: usize, const N: usize> Default for Family<D, N> {
    fn default() -> Self {
        Self { elements: Vec::new(), first: Vec::new(), reflected: Vec::new() }
    }
}

impl<const D: usize, const N: usize> Family<D, N> {
    /// Adds an element whose force and opening velocity begin at `start` times what is
    /// typical of it; its index.
    pub(super) fn add(&mut self, part: &Part<D>, cost: f64, [force, opening]: [f64; 2]) -> usize {
        let end = |end: &Option<(usize, [Rows<D>; 6])>| {
            end.as_ref().map(|(body, columns)| End { body: *body, columns: std::array::from_fn(|k| columns[k]) })
        };
        self.elements.push(Element::new(
            part.ends.each_ref().map(end),
            part.cone == Cone::Free,
            cost,
            [force * part.start, opening / part.start],
        ));
        self.first.push(part.first);
        self.first.len() - 1
    }

    /// Finds its places in the network's matrix.
    pub(super) fn place(&mut self, network: &Network<D>) {
        for element in &mut self.elements {
            element.place(network);
        }
        if N > 1 {
            self.reflected = self.elements.iter().map(Element::reflected).collect();
        }
    }

    /// Finds the scaling of its elements and adds their stiffness to the network's matrix; whether
    /// there is a scaling.
    pub(super) fn stiffen(&mut self, network: &mut Network<D>) -> bool {
        for (index, element) in self.elements.iter_mut().enumerate() {
            if !element.rescale() {
                return false;
            }
            element.add_stiffness(self.reflected.get(index), network.matrix_mut());
        }
        true
    }

    /// Adds the stiffness of its elements, which have their scaling, to the network's matrix.
    pub(super) fn add_stiffness(&self, network: &mut Network<D>) {
        for (index, element) in self.elements.iter().enumerate() {
            element.add_stiffness(self.reflected.get(index), network.matrix_mut());
        }
    }

    /// Calls `each` with every element's first variable and its forces.
    pub(super) fn forces(&self, each: &mut impl FnMut(usize, &[f64])) {
        for (element, first) in self.elements.iter().zip(&self.first) {
            each(*first, &element.x);
        }
    }
}

/// Evaluates an expression for every element, whatever its size.
macro_rules! each {
    ($families:expr, $iter:ident, $element:ident => $body:expr) => {
        for $element in $families.one.elements.$iter() {
            $body
        }
        for $element in $families.two.elements.$iter() {
            $body
        }
        for $element in $families.three.elements.$iter() {
            $body
        }
        for $element in $families.six.elements.$iter() {
            $body
        }
    };
}

pub(super) use each;

/// The elements by number of variables.
pub(super) struct Families<const D: usize> {
    pub one: Family<D, 1>,
    pub two: Family<D, 2>,
    pub three: Family<D, 3>,
    pub six: Family<D, 6>,
}
