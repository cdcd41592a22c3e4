//! Drawing orders, and reproducible pseudorandom numbers.

/// A seeded generator (xorshift, Marsaglia 2003).
pub struct Numbers(u64);

impl Numbers {
    pub fn seeded(seed: u64) -> Self {
        Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// Returns a number below `end`.
    pub fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 32) % u64::from(end)) as u32
    }
}

/// Returns all orders of up to four things, and sixteen of more.
pub fn orders<T: Clone>(things: &[T]) -> Vec<Vec<T>> {
    if things.len() <= 4 { all(things) } else { (0..16).map(|seed| shuffled(things, seed)).collect() }
}

fn all<T: Clone>(things: &[T]) -> Vec<Vec<T>> {
    if things.is_empty() {
        return vec![Vec::new()];
    }
    let mut orders = Vec::new();
    for first in 0..things.len() {
        let mut rest = things.to_vec();
        let head = rest.remove(first);
        orders.extend(all(&rest).into_iter().map(|tail| [vec![head.clone()], tail].concat()));
    }
    orders
}

fn shuffled<T: Clone>(things: &[T], seed: u64) -> Vec<T> {
    let mut numbers = Numbers::seeded(seed + 1);
    let mut things = things.to_vec();
    for end in (1..things.len()).rev() {
        things.swap(end, numbers.below(end as u32 + 1) as usize);
    }
    things
}

#[test]
fn all_orders_of_four_things_are_different() {
    let mut orders = orders(&[1, 2, 3, 4]);
    orders.sort();
    orders.dedup();
    assert_eq!(orders.len(), 24);
}
