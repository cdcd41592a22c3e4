//! Drawing orders, and reproducible pseudorandom numbers.

#[path = "../../../../tests/oracle/numbers.rs"]
pub mod numbers;

pub use numbers::Numbers;

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
    numbers.shuffle(&mut things);
    things
}

#[test]
fn all_orders_of_four_things_are_different() {
    let mut orders = orders(&[1, 2, 3, 4]);
    orders.sort();
    orders.dedup();
    assert_eq!(orders.len(), 24);
}
