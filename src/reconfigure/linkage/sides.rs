//! Every way to split a robot in two about a joint or a connection that turns.
//!
//! Knows graphs only.

/// A graph by its edges; an edge may occur more than once.
#[derive(Clone, Debug)]
pub struct Graph {
    neighbours: Vec<Vec<usize>>,
}

impl Graph {
    /// A graph with this many vertices and these edges.
    pub fn new(vertices: usize, edges: impl IntoIterator<Item = [usize; 2]>) -> Self {
        let mut neighbours = vec![Vec::new(); vertices];
        for [a, b] in edges {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        Self { neighbours }
    }

    /// Every set of vertices that holds together, with `inside` in it and `outside` not, whose complement holds
    /// together too (if `both` says so), in a fixed order; as one flag for each vertex.
    pub fn sides(&self, inside: usize, outside: usize, both: bool) -> Vec<Vec<bool>> {
        let mut sides = vec![Side::Open; self.neighbours.len()];
        sides[inside] = Side::In;
        sides[outside] = Side::Out;
        let mut found = Vec::new();
        self.split(&mut sides, outside, both, &mut found);
        found
    }

    /// Every way to split the graph between two vertices: which of them (0 or 1) is in a set that holds together,
    /// with the set; whether the other vertices must hold together with the other end says `both`.
    pub fn both_sides(&self, [first, second]: [usize; 2], both: bool) -> Vec<(usize, Vec<bool>)> {
        let of_first = self.sides(first, second, both);
        let of_second = if both {
            let complement = |side: &Vec<bool>| side.iter().map(|inside| !inside).collect();
            of_first.iter().map(complement).collect()
        } else {
            self.sides(second, first, both)
        };
        let first = of_first.into_iter().map(|side| (0, side));
        first.chain(of_second.into_iter().map(|side: Vec<bool>| (1, side))).collect()
    }

    /// Adds all sets that go on from here: the first open vertex next to the set is in or out.
    fn split(&self, sides: &mut [Side], outside: usize, both: bool, found: &mut Vec<Vec<bool>>) {
        if both && !self.rest_holds(sides, outside) {
            return;
        }
        let is_next = |&v: &usize| sides[v] == Side::Open && self.neighbours[v].iter().any(|&n| sides[n] == Side::In);
        let Some(next) = (0..sides.len()).find(is_next) else {
            // What is still open is out of reach of the set, so it is outside.
            found.push(sides.iter().map(|&side| side == Side::In).collect());
            return;
        };
        for side in [Side::In, Side::Out] {
            sides[next] = side;
            self.split(sides, outside, both, found);
        }
        sides[next] = Side::Open;
    }

    /// Whether every vertex that is outside for good can still hold on to `outside`, and every open one to either.
    fn rest_holds(&self, sides: &[Side], outside: usize) -> bool {
        let mut reached = vec![false; sides.len()];
        reached[outside] = true;
        let mut queue = vec![outside];
        while let Some(vertex) = queue.pop() {
            for &next in &self.neighbours[vertex] {
                if !reached[next] && sides[next] != Side::In {
                    reached[next] = true;
                    queue.push(next);
                }
            }
        }
        sides.iter().zip(&reached).all(|(&side, &reached)| side != Side::Out || reached)
            && self.open_are_reached(sides, reached)
    }

    /// Whether every open vertex that cannot hold on to the outside can join the set.
    fn open_are_reached(&self, sides: &[Side], mut reached: Vec<bool>) -> bool {
        let mut queue: Vec<usize> = (0..sides.len()).filter(|&v| sides[v] == Side::In).collect();
        for &vertex in &queue {
            reached[vertex] = true;
        }
        while let Some(vertex) = queue.pop() {
            for &next in &self.neighbours[vertex] {
                if !reached[next] && sides[next] == Side::Open {
                    reached[next] = true;
                    queue.push(next);
                }
            }
        }
        reached.into_iter().all(|reached| reached)
    }
}

/// Where a vertex is, as far as decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Open,
    In,
    Out,
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn holds(edges: &[[usize; 2]], set: &[bool], from: usize) -> bool {
        let mut reached = vec![false; set.len()];
        reached[from] = true;
        for _ in 0..set.len() {
            for &[a, b] in edges {
                if set[a] && set[b] && (reached[a] || reached[b]) {
                    (reached[a], reached[b]) = (true, true);
                }
            }
        }
        set.iter().zip(reached).all(|(&member, reached)| !member || reached)
    }

    proptest! {
        #[test]
        fn all_splits_and_no_others_are_found(
            edges in prop::collection::vec((0..7_usize, 0..7_usize), 0..14),
            both in any::<bool>(),
        ) {
            let edges: Vec<[usize; 2]> = edges.into_iter().filter(|(a, b)| a != b).map(|(a, b)| [a, b]).collect();
            let found = Graph::new(7, edges.iter().copied()).sides(2, 5, both);
            let mut expected = Vec::new();
            for bits in 0..128_u32 {
                let set: Vec<bool> = (0..7).map(|v| bits >> v & 1 == 1).collect();
                let rest: Vec<bool> = set.iter().map(|member| !member).collect();
                if set[2] && !set[5] && holds(&edges, &set, 2) && (!both || holds(&edges, &rest, 5)) {
                    expected.push(set);
                }
            }
            let mut sorted = found.clone();
            sorted.sort();
            expected.sort();
            prop_assert_eq!(sorted, expected);
        }
    }
}
