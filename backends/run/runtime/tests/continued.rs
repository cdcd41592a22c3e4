//! Closures of effects with peeling: the iterations interrupt their loop between two fragments, and the image is that of the same closure
//! over an A-buffer, bit for bit. On the driver, whole and in slices, and on the CPU device.

use fragbuf_templates::vocabulary::Capability;

use crate::drivers::scene::Quad;
use crate::order::Numbers;
use crate::peeling::{SLICES, counted, drawn_on_cpu, scene};
use crate::stage::{described, device};

/// What follows the name of a storage: choices that keep the fragments of an iteration.
const PEELED: [&str; 6] = [
    "from f2b_ll",
    "from f2b_kb",
    "from ab_sb { peeling: depth_layers; sort: insertion { layers: 64 };",
    "from k_peeling { keep 3;",
    "from mdt32_coplanar { keep 2; peeling: k_layers;",
    "from kb_ll { keep 1; peeling: k_layers;",
];

/// Effects: sums, all light in front of the first opaque fragment, solids, the third layer by `return`, and by its index.
const EFFECTS: [&str; 6] = [
    "let mut sum = Vec3::ZERO; for f in fragments { sum += f.depth * f.color.truncate(); } (0.1 * sum).extend(1.0)",
    "let mut light = Vec3::ZERO; let mut left = 1.0; for f in fragments { light += left * f.color.w * f.color.truncate(); \
     left *= 1.0 - f.color.w; if left < 0.2 { break; } } light.extend(1.0 - left)",
    "let mut inside = false; let mut count = 0; let mut seen = Vec4::ZERO; for f in fragments { if f.color.x > 0.5 { inside = !inside; \
     count += 1; } if inside && seen.w == 0.0 { seen = f.color.truncate().extend(1.0); } } if count % 2 == 1 { seen *= 0.5; } seen",
    "let mut left = 3; for f in fragments { left -= 1; if left == 0 { return f.color.truncate().extend(1.0); } } vec4(0.0, 0.0, 1.0, 1.0)",
    "let mut all = Vec4::ZERO; for (i, f) in fragments.iter().enumerate() { if i % 3 == 1 { all += 0.2 * f.color; } else { all.w = \
     0.01 * i as f32; } } all",
    "let scale = 0.5; let twice = 2.0 * scale; let mut nearest = 1.0; let early = nearest; for f in fragments { for i in 0..3 { if i == 1 \
     { break; } nearest = f.depth.min(nearest) * scale + 0.1 * twice; } } vec4(nearest, early, 0.0, 1.0)",
];

fn description(head: &str, effect: &str) -> String {
    let open = if head.contains('{') { "" } else { " {" };
    format!("buffer Continued {head}{open} counters: all; resolve |fragments| {{ {effect} }} }}")
}

fn scenes() -> Vec<Vec<Quad>> {
    vec![scene(3, 1), scene(5, 17), scene(7, 40), Vec::new()]
}

#[test]
fn closures_continue_where_an_iteration_interrupts_them() {
    let stage = device();
    let mut numbers = Numbers::seeded(12);
    for effect in EFFECTS {
        let a_buffer = described(&description("from ab_sb { sort: insertion { layers: 64 };", effect));
        for head in PEELED {
            let variant = described(&description(head, effect));
            let is_peeled = |row: &fragbuf_templates::vocabulary::Row| row.provides.contains(&Capability::KeepsLater);
            assert!(variant.choices.iter().any(|chosen| is_peeled(&chosen.alternatives[0].row)), "{head}");
            for mut quads in scenes() {
                let (expected, ..) = counted(&stage, &a_buffer, &quads, None);
                for slice in SLICES {
                    let (seen, loops, counters) = counted(&stage, &variant, &quads, slice);
                    let what = format!("{head}: {effect}: {} quads, slices of {slice:?} rows", quads.len());
                    let differs = seen.iter().zip(&expected).find(|(one, other)| one != other);
                    assert_eq!((differs, counters.lost()), (None, 0), "{what}");
                    assert!(quads.len() < 17 || loops[0].iterations > 1, "{what}: one iteration interrupts nothing");
                    numbers.shuffle(&mut quads);
                }
                assert_eq!(
                    drawn_on_cpu(&variant, &quads),
                    drawn_on_cpu(&a_buffer, &quads),
                    "{head}: {effect}: the CPU device"
                );
            }
        }
    }
}

/// An effect with a value that depends on the order of arrival would differ; so would one that begins again in each iteration.
#[test]
fn the_effects_tell_fragments_and_iterations_apart() {
    let stage = device();
    let quads = scene(7, 40);
    let images: Vec<_> = EFFECTS
        .iter()
        .map(|effect| counted(&stage, &described(&description("from f2b_ll", effect)), &quads, None).0)
        .collect();
    for (at, image) in images.iter().enumerate() {
        assert!(images[..at].iter().all(|other| other != image), "{}", EFFECTS[at]);
    }
}
