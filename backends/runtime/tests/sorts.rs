//! Every sort against the oracle, with more layers than a pass meets every day. What a pixel shows is a checksum over the
//! identities of its fragments in their order, so that any two fragments in each other's place show.

use fragbuf_model::Variant;
use fragbuf_runtime::{Room, Settings, Sizing};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Fact;

use crate::capture::{compare, scattered};
use crate::oracle::Rules;
use crate::order::Numbers;
use crate::quads::{Quad, SIZE};
use crate::stage::{described, device, renderer, see, settings, shaders};

/// Each step multiplies what was and adds the next, so the order matters; 12 bits of it become a colour of 16 levels a
/// channel, which no rounding confuses.
const CHECKSUM: &str = "
    buffer Checksum from ab_ll {
        fragment { color: rgba8, depth: f32, id: u32 }
        sort: SORT;
        resolve |fragments, u| {
            let mut sum = 1;
            for f in fragments {
                sum = (sum * 33 + f.id + 1) % 65521;
            }
            vec4((sum % 16) as f32 / 15.0, (sum / 16 % 16) as f32 / 15.0, (sum / 256 % 16) as f32 / 15.0, 1.0)
        }
    }";

fn rules() -> Rules {
    fn words(quad: &Quad) -> Vec<u32> {
        vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), quad.id]
    }
    Rules {
        admits: |_| true,
        words,
        nearer: words,
        resolve: |kept| {
            let sum = kept.iter().fold(1u32, |sum, quad| (sum * 33 + quad.id + 1) % 65521);
            [sum % 16, sum / 16 % 16, sum / 256 % 16, 15].map(|level| f64::from(level) / 15.0)
        },
    }
}

/// The nearest `layers` of a pixel only: what a resolve pass shows that holds no more.
fn rules_of_eight() -> Rules {
    Rules { resolve: |kept| (rules().resolve)(&kept[..kept.len().min(8)]), ..rules() }
}

/// Every sort that puts fragments in order, and the hybrid on either side of its border.
fn sorts() -> Vec<String> {
    let registry = Registry::builtin();
    let sorts = registry.rows_of("sort").filter(|row| row.offers.contains(&Fact::Sorted));
    let mut written: Vec<String> = sorts.map(|row| row.key.clone()).collect();
    assert!(written.len() >= 4, "{written:?}");
    written.extend(["hybrid { insertion: 0 }".to_owned(), "hybrid { insertion: 4096 }".to_owned()]);
    written
}

fn with_layers(sort: &str, layers: u32) -> Variant {
    let sort = match sort.strip_suffix(" }") {
        Some(options) => format!("{options}, layers: {layers} }}"),
        None => format!("{sort} {{ layers: {layers} }}"),
    };
    described(&CHECKSUM.replace("SORT", &sort))
}

/// `count` layers over the whole frame in random order; of some, depth is the same, of some of those colour too.
fn layers(count: u32, seed: u64) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let quad = |id| {
        let color = [numbers.below(2) as u8 * 255, 0, 0, 255];
        Quad::whole(numbers.below(1 + count / 2) as f32 / 64.0, color).named(id)
    };
    let mut quads: Vec<Quad> = (0..count).map(quad).collect();
    for index in (1..quads.len()).rev() {
        quads.swap(index, numbers.below(index as u32 + 1) as usize);
    }
    quads
}

fn roomy() -> Settings {
    Settings { sizing: Sizing::Reserve(Room::Fragments(64 * SIZE * SIZE)), ..settings() }
}

#[test]
fn every_sort_orders_any_number_of_layers() {
    let stage = device();
    for sort in sorts() {
        let mut renderer = renderer(&stage, &shaders(&with_layers(&sort, 64), "wgsl"), &roomy()).unwrap();
        let mut scenes: Vec<Vec<Quad>> =
            [1, 2, 3, 4, 5, 8, 15, 16, 17, 31, 32, 33, 63, 64].into_iter().map(|count| layers(count, 5)).collect();
        // Quads anywhere: every pixel holds a number of its own.
        scenes.extend([scattered(64, 3), scattered(64, 4), layers(64, 6), Vec::new()]);
        for quads in scenes {
            let seen = see(&stage, &mut renderer, &quads);
            compare(&sort, &seen, &rules(), &quads, (None, None));
            assert_eq!(seen.counters.lost(), 0, "{sort}: {:?}", seen.counters);
        }
    }
}

#[test]
fn every_sort_keeps_the_nearest_of_more_than_fit() {
    let stage = device();
    for sort in sorts() {
        let mut renderer = renderer(&stage, &shaders(&with_layers(&sort, 8), "wgsl"), &roomy()).unwrap();
        for quads in [layers(9, 1), layers(40, 2), scattered(64, 5)] {
            let seen = see(&stage, &mut renderer, &quads);
            compare(&sort, &seen, &rules_of_eight(), &quads, (None, None));
            let beyond = |pixel: &Vec<_>| pixel.len().saturating_sub(8) as u32;
            assert_eq!(seen.counters.get("layers_exceeded"), seen.kept.iter().map(beyond).sum::<u32>(), "{sort}");
        }
    }
}
