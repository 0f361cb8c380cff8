//! The open list: a priority queue that breaks ties by order of generation.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// An item on the queue.
#[derive(Clone, Copy)]
pub(crate) struct Entry<P, T> {
    pub priority: P,
    generation: u64,
    pub item: T,
}

/// Items by priority, greatest first, then oldest first.
pub(crate) struct Queue<P, T> {
    heap: BinaryHeap<Entry<P, T>>,
    generation: u64,
}

impl<P: Ord, T> Queue<P, T> {
    pub fn new() -> Self {
        Queue { heap: BinaryHeap::new(), generation: 0 }
    }

    pub fn push(&mut self, priority: P, item: T) {
        self.heap.push(Entry { priority, generation: self.generation, item });
        self.generation += 1;
    }

    /// Puts back an entry with another priority; its age stays.
    pub fn reinsert(&mut self, entry: Entry<P, T>) {
        self.heap.push(entry);
    }

    pub fn pop(&mut self) -> Option<Entry<P, T>> {
        self.heap.pop()
    }

    pub fn peek(&self) -> Option<&Entry<P, T>> {
        self.heap.peek()
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        self.heap.len() * size_of::<Entry<P, T>>()
    }
}

impl<P: Ord, T> Ord for Entry<P, T> {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.priority, Reverse(self.generation)).cmp(&(&other.priority, Reverse(other.generation)))
    }
}

impl<P: Ord, T> PartialOrd for Entry<P, T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<P: Ord, T> PartialEq for Entry<P, T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<P: Ord, T> Eq for Entry<P, T> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_comes_first_and_then_the_oldest() {
        let mut queue = Queue::new();
        for number in 0..30 {
            queue.push(number % 3, number);
        }
        let mut first = queue.pop().expect("thirty were pushed");
        assert_eq!(first.item, 2);
        first.priority = 1;
        queue.reinsert(first);
        let order: Vec<i32> = std::iter::from_fn(|| queue.pop()).map(|entry| entry.item).collect();
        let twos = (0..30).filter(|number| number % 3 == 2 && *number != 2);
        let ones = (0..30).filter(|number| number % 3 == 1 || *number == 2);
        // The one put back is older than all ones but the first.
        assert_eq!(order, twos.chain(ones).chain((0..30).filter(|number| number % 3 == 0)).collect::<Vec<_>>());
    }
}
