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
use crate::stage::{described, device, renderer, see, settings, shaders, technique};

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
    let more = ["hybrid { insertion: 0 }", "hybrid { insertion: 4096 }", "lplus { batch: 1 }", "lplus { batch: 7 }"];
    written.extend(more.map(str::to_owned));
    written
}

/// Whether a sort holds a number of layers that is set; the others hold any number.
fn is_bounded(sort: &str) -> bool {
    let key = sort.split(' ').next().unwrap();
    Registry::builtin().row("sort", key).unwrap().parameters.iter().any(|parameter| parameter.name == "layers")
}

fn with_layers(sort: &str, layers: u32) -> Variant {
    let sort = match sort.strip_suffix(" }") {
        _ if !is_bounded(sort) => sort.to_owned(),
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
    for sort in sorts().iter().filter(|sort| is_bounded(sort)) {
        let mut renderer = renderer(&stage, &shaders(&with_layers(sort, 8), "wgsl"), &roomy()).unwrap();
        for quads in [layers(9, 1), layers(40, 2), scattered(64, 5)] {
            let seen = see(&stage, &mut renderer, &quads);
            compare(sort, &seen, &rules_of_eight(), &quads, (None, None));
            let beyond = |pixel: &Vec<_>| pixel.len().saturating_sub(8) as u32;
            assert_eq!(seen.counters.get("layers_exceeded"), seen.kept.iter().map(beyond).sum::<u32>(), "{sort}");
        }
    }
}

/// More than any array of the other sorts holds by itself.
#[test]
fn sorts_without_an_array_for_all_leave_none_out() {
    let stage = device();
    let free: Vec<String> = sorts().into_iter().filter(|sort| !is_bounded(sort)).collect();
    assert!(!free.is_empty());
    for sort in free {
        let sizing = Sizing::Reserve(Room::Fragments(200 * SIZE * SIZE));
        let settings = Settings { sizing, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&with_layers(&sort, 0), "wgsl"), &settings).unwrap();
        // Many equal depths and colours, then one fragment again and again.
        let equal = vec![Quad::whole(0.5, [9, 9, 9, 255]).named(3); 90];
        for quads in [layers(128, 1), layers(97, 2), layers(65, 3), equal] {
            let seen = see(&stage, &mut renderer, &quads);
            compare(&sort, &seen, &rules(), &quads, (None, None));
            assert_eq!(seen.counters.lost(), 0, "{sort}: {:?}", seen.counters);
        }
    }
}

/// Farthest first, and each fragment beside the one before it: what is gathered on demand must serve any order of asking.
#[test]
fn effects_may_go_back() {
    const BACK: &str = "
        let mut sum = 1;
        for (i, f) in fragments.iter().enumerate().rev() {
            sum = (sum * 33 + f.id + 1 + fragments[i / 2].id) % 65521;
        }";
    let stage = device();
    let rules = Rules {
        resolve: |kept| {
            let step = |sum: u32, index: usize| (sum * 33 + kept[index].id + 1 + kept[index / 2].id) % 65521;
            let sum = (0..kept.len()).rev().fold(1, step);
            [sum % 16, sum / 16 % 16, sum / 256 % 16, 15].map(|level| f64::from(level) / 15.0)
        },
        ..rules()
    };
    let forward = CHECKSUM.split("let mut sum").nth(1).unwrap().split("vec4").next().unwrap();
    for sort in sorts() {
        let sort_option =
            if is_bounded(&sort) && !sort.contains('{') { format!("{sort} {{ layers: 64 }}") } else { sort.clone() };
        let text = CHECKSUM.replace(&format!("let mut sum{forward}"), BACK).replace("SORT", &sort_option);
        assert!(text.contains("rev()"));
        let mut renderer = renderer(&stage, &shaders(&described(&text), "wgsl"), &roomy()).unwrap();
        // A software driver ends loops after 65,535 rounds in all: batches of one are read again for every step back.
        for quads in [layers(1, 1), layers(30, 2), scattered(40, 5)] {
            compare(&sort, &see(&stage, &mut renderer, &quads), &rules, &quads, (None, None));
        }
    }
}

/// Class by class nothing is resolved or counted twice, whatever counts where the pixel is read.
#[test]
fn passes_for_classes_of_pixels_count_once() {
    let stage = device();
    for key in ["kb_ll", "kb_ab_ll"] {
        let counted = |sort: &str| {
            let set = [("k", "20"), ("counters", "all"), ("sort", sort)];
            let mut renderer = renderer(&stage, &shaders(&technique(key, &set), "wgsl"), &roomy()).unwrap();
            [layers(40, 1), scattered(64, 2)].map(|quads| {
                let seen = see(&stage, &mut renderer, &quads);
                (seen.pixels, seen.counters)
            })
        };
        let expected = counted("insertion");
        assert!(expected[0].1.lost() > 0);
        for sort in ["lplus", "block", "backwards_memory"] {
            assert!(counted(sort) == expected, "{key} with {sort}");
        }
    }
}
