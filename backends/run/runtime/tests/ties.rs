//! Which of fragments with equal depths stay, where the description names the attribute that decides.

use fragbuf_templates::vocabulary::Fact;

use crate::order::orders;
use crate::quads::Quad;
use crate::stage::{described, device, renderer, see, settings, shaders};

/// `id` decides, though it is named last: the words of `color` would choose others.
const BY_ID: &str = "
    buffer Ties from STORAGE {
        fragment { color: rgba8, depth: f32, id: u32 }
        keep 2;
        ties: attribute { by: id };
    }";

#[test]
fn the_attribute_that_is_named_decides() {
    let quads: Vec<Quad> = (0..4u8).map(|i| Quad::whole(0.5, [200 - 50 * i, 0, 0, 255]).named(u32::from(i))).collect();
    for storage in ["kplus_array", "kplus_heap", "mdt32_coplanar", "kplus_array_revised", "kb_ab_ll"] {
        let stage = device();
        let variant = described(&BY_ID.replace("STORAGE", storage));
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
        let keeps_all = renderer.plan().selection.offers().contains(&Fact::KeepsAll);
        for quads in orders(&quads) {
            let seen = see(&stage, &mut renderer, &quads);
            if keeps_all {
                // It keeps all and chooses when it resolves: the two shown are opaque, so the first covers.
                assert!((seen.pixels[0][0] - 200.0 / 255.0).abs() < 1.0 / 255.0, "{:?}", seen.pixels[0]);
                continue;
            }
            let mut kept: Vec<u32> = seen.kept[0].iter().map(|words| words[1]).collect();
            kept.sort_unstable();
            assert_eq!(kept, [0, 1], "{storage}: {:?} of {quads:?}", seen.kept[0]);
        }
    }
}
