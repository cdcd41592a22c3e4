//! Blending that ends when little light would pass: what is left out is within the bound that the parameter states, and a
//! sort that reads on demand reads less.

use fragbuf_runtime::{Room, Settings, Sizing};

use crate::order::Numbers;
use crate::quads::{Quad, SIZE};
use crate::stage::{device, renderer, see, settings, shaders, technique};

/// Layers over the whole frame, of any colour and from faint to almost opaque; white ones where the bound is tightest.
fn piles() -> Vec<Vec<Quad>> {
    let mut numbers = Numbers::seeded(5);
    let mut pile = |count: u32, alpha: (u32, u32)| -> Vec<Quad> {
        let quad = |id| {
            let [red, green, blue] = std::array::from_fn(|_| numbers.below(256) as u8);
            let alpha = (alpha.0 + numbers.below(alpha.1 - alpha.0)) as u8;
            Quad::whole(numbers.below(64) as f32 / 64.0, [red, green, blue, alpha]).named(id)
        };
        (0..count).map(quad).collect()
    };
    let mut piles = vec![pile(60, (1, 255)), pile(60, (20, 60)), pile(5, (200, 255)), pile(40, (250, 255))];
    let black_before_white = (0..60).map(|id| {
        let shade = if id < 20 { 0 } else { 255 };
        Quad::whole(id as f32 / 64.0, [shade, shade, shade, 40])
    });
    piles.push(black_before_white.collect());
    piles
}

#[test]
fn what_is_left_out_is_within_the_bound() {
    let stage = device();
    let roomy = Settings { sizing: Sizing::Reserve(Room::Fragments(64 * SIZE * SIZE)), ..settings() };
    for sort in ["insertion", "lplus", "block"] {
        let exact = |opaque: &str| {
            let set = [("sort", sort), ("resolve.opaque", opaque)];
            let mut renderer = renderer(&stage, &shaders(&technique("ab_ll", &set), "wgsl"), &roomy).unwrap();
            piles().iter().map(|quads| see(&stage, &mut renderer, quads).pixels).collect::<Vec<_>>()
        };
        let whole = exact("0");
        for opaque in [1_u32, 10, 100, 500] {
            let mut apart = 0.0_f32;
            for (whole, ended) in whole.iter().zip(exact(&opaque.to_string())) {
                // Over an opaque background, whose share of the light is left out too: at most 1 a channel.
                let channels = whole.iter().flatten().zip(ended.iter().flatten());
                apart = channels.fold(apart, |apart, (whole, ended)| apart.max((whole - ended).abs()));
            }
            // The target is of half floats.
            assert!(apart <= opaque as f32 / 1000.0 + 1.0 / 1024.0, "{sort}: {apart} for {opaque}");
            assert!(
                opaque < 10 || apart > 0.05 * opaque as f32 / 1000.0,
                "{sort}: {apart} for {opaque}: nothing ended"
            );
        }
    }
}
