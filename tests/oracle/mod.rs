//! Tests the reference implementation of fragment buffers by its properties. Pixel tests compare devices with it.

pub mod reference;

pub use reference::{depth_key, ordered_key, rgba8};

use crate::cases::Random;

/// A stored fragment: the words of an entry, the key first.
pub type Entry = Vec<u32>;

/// Returns the k best fragments of a pixel, best first. `None` keeps all.
pub fn kept(fragments: &[Entry], k: Option<u32>) -> Vec<Entry> {
    reference::best(fragments, Clone::clone, k)
}

/// Composites (depth, straight rgba) layers, in any order, front to back with *over*. The result is premultiplied.
pub fn over(layers: &[(f32, [f32; 4])]) -> [f64; 4] {
    let mut sorted = layers.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    reference::over(sorted.iter().map(|(_, color)| color.map(f64::from)))
}

fn fragments(random: &mut Random, count: usize) -> Vec<Entry> {
    // Few values: ties in the key and in whole entries are common.
    (0..count).map(|_| vec![random.below(5) as u32, random.below(3) as u32]).collect()
}

fn shuffled(list: &[Entry], random: &mut Random) -> Vec<Entry> {
    let mut list = list.to_vec();
    for index in (1..list.len()).rev() {
        list.swap(index, random.below(index + 1));
    }
    list
}

#[test]
fn the_kept_set_depends_on_the_multiset_alone() {
    let mut random = Random(1);
    for run in 0..500 {
        let all = fragments(&mut random, run % 12);
        let k = Some(1 + random.below(6) as u32);
        assert_eq!(kept(&all, k), kept(&shuffled(&all, &mut random), k));
    }
}

#[test]
fn the_kept_set_is_a_subset_without_a_better_fragment_outside() {
    let mut random = Random(2);
    for run in 0..500 {
        let all = fragments(&mut random, run % 12);
        let k = 1 + random.below(6);
        let best = kept(&all, Some(k as u32));
        assert_eq!(best.len(), k.min(all.len()));
        let mut rest = all.clone();
        for entry in &best {
            let index = rest.iter().position(|other| other == entry).expect("a kept entry is one of the fragments");
            rest.remove(index);
        }
        assert!(rest.iter().all(|out| best.iter().all(|kept| kept <= out)));
        assert_eq!(kept(&all, None).len(), all.len());
    }
}

#[test]
fn inserting_one_by_one_gives_the_same_set() {
    let mut random = Random(3);
    for run in 0..500 {
        let all = fragments(&mut random, run % 12);
        let k = Some(1 + random.below(6) as u32);
        let streamed =
            all.iter().fold(Vec::new(), |held: Vec<Entry>, new| kept(&[held, vec![new.clone()]].concat(), k));
        assert_eq!(streamed, kept(&all, k));
    }
}

#[test]
fn keys_are_in_the_order_of_their_values() {
    let mut random = Random(4);
    let mut values: Vec<f32> =
        (0..2000).map(|_| f32::from_bits(random.next() as u32)).filter(|value| !value.is_nan()).collect();
    values.extend([0.0, -0.0, 1.0, f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::MIN_POSITIVE]);
    for pair in values.windows(2) {
        assert_eq!(ordered_key(pair[0]).cmp(&ordered_key(pair[1])), pair[0].total_cmp(&pair[1]), "{pair:?}");
        let (a, b) = (pair[0].abs().min(1.0), pair[1].abs().min(1.0));
        assert_eq!(depth_key(a).cmp(&depth_key(b)), a.total_cmp(&b));
        assert!(depth_key(a) < u32::MAX && ordered_key(pair[0]) < u32::MAX, "no key is EMPTY");
    }
    assert_eq!(depth_key(-0.0), depth_key(0.0));
}

#[test]
fn over_of_known_layers() {
    let red = [1.0, 0.0, 0.0, 0.5];
    let green = [0.0, 1.0, 0.0, 1.0];
    assert_eq!(over(&[]), [0.0; 4]);
    assert_eq!(over(&[(0.2, red), (0.7, green)]), [0.5, 0.5, 0.0, 1.0]);
    assert_eq!(over(&[(0.7, red), (0.2, green)]), [0.0, 1.0, 0.0, 1.0]);
}

#[test]
fn over_ignores_arrival_order_and_transparent_layers() {
    let mut random = Random(5);
    for _ in 0..200 {
        let count = random.below(8);
        let mut layers: Vec<(f32, [f32; 4])> = (0..count)
            .map(|index| (index as f32 * 0.1, [0.0; 4].map(|_: f32| random.below(256) as f32 / 255.0)))
            .collect();
        let color = over(&layers);
        assert!(color.iter().all(|channel| (0.0..=1.0).contains(channel)));
        assert!(color[..3].iter().all(|channel| *channel <= color[3] + 1e-6), "premultiplied");
        layers.reverse();
        assert_eq!(over(&layers), color);
        layers.push((0.05, [1.0, 1.0, 1.0, 0.0]));
        assert_eq!(over(&layers), color);
    }
}

#[test]
fn colours_are_packed_to_the_nearest() {
    assert_eq!(rgba8([1.0, 0.0, 0.5, 2.0]), 0xff80_00ff);
    let mut random = Random(6);
    for _ in 0..200 {
        let channel = random.below(10_001) as f32 / 10_000.0;
        let byte = rgba8([channel, 0.0, 0.0, 0.0]) as f32;
        assert!((byte / 255.0 - channel).abs() <= 1.0 / 510.0 + 1e-7);
    }
}
