//! Tie-breaking among fragments of equal depth by a named attribute.

use fragbuf_templates::vocabulary::Capability;

use crate::order::orders;
use crate::quads::Quad;
use crate::stage::{described, device, render_frame, renderer, settings, shaders};

/// `id` decides although it is the last attribute: the words of `color` would select other fragments.
const BY_ID: &str = "
    buffer Ties from STORAGE {
        fragment { color: rgba8, depth: f32, id: u32 }
        keep 2;
        ties: attribute { by: id };
    }";

#[test]
fn the_named_attribute_decides() {
    let quads: Vec<Quad> = (0..4u8).map(|i| Quad::whole(0.5, [200 - 50 * i, 0, 0, 255]).named(u32::from(i))).collect();
    for storage in ["kplus_array", "kplus_heap", "mdt32_coplanar", "kplus_array_revised", "kb_ab_ll"] {
        let stage = device();
        let variant = described(&BY_ID.replace("STORAGE", storage));
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
        let keeps_all = renderer.plan().selection.provides().contains(&Capability::KeepsAll);
        for quads in orders(&quads) {
            let seen = render_frame(&stage, &mut renderer, &quads);
            if keeps_all {
                // The storage keeps all and selects on resolve: the selected two are opaque, so the first hides the other.
                assert!((seen.pixels[0][0] - 200.0 / 255.0).abs() < 1.0 / 255.0, "{:?}", seen.pixels[0]);
                continue;
            }
            let mut kept: Vec<u32> = seen.kept[0].iter().map(|words| words[1]).collect();
            kept.sort_unstable();
            assert_eq!(kept, [0, 1], "{storage}: {:?} of {quads:?}", seen.kept[0]);
        }
    }
}
