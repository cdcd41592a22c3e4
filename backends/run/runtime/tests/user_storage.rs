//! A storage from a user file is tested like a built-in one: the kept fragments are read through the file's functions, on the
//! software driver and on the CPU device.

use std::path::Path;

use fragbuf_codegen::validate_user_row;
use fragbuf_cpu::FragmentOrder;
use fragbuf_model::{Variant, check};
use fragbuf_syntax::{parse, row};
use fragbuf_templates::Registry;

use crate::capture::cases;
use crate::cpu_device;
use crate::oracle::{PLAIN, Words, fragments, pixels};
use crate::order::orders;
use crate::quads::Quad;
use crate::stage::{device, render_frame, renderer, settings, shaders};

const FILE: &str = "first_k.wgsl";

/// Checks the example with `keep k`.
fn variant(k: u32) -> Variant {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/user_storage");
    let source = std::fs::read_to_string(folder.join(FILE)).unwrap();
    let description = format!("buffer FirstK {{\n    storage: wgsl(\"{FILE}\");\n    keep {k};\n}}\n");
    let draft = parse(&description, "first_k.fragbuf").draft.unwrap();
    let choice = draft.choices.iter().find(|choice| choice.axis.value == "storage").unwrap();
    let key = &choice.alternatives[0].value.value;
    let registry = Registry::builtin();
    let validated = row(&source, FILE, key, FILE).and_then(|row| validate_user_row(row, &registry));
    let registry = registry.clone().with(validated.unwrap_or_else(|diagnostics| panic!("{diagnostics}")));
    check(&draft, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// Returns the first `k` fragments of every pixel, each pixel's in ascending order of their words.
fn first(quads: &[Quad], k: u32) -> Vec<Vec<Words>> {
    let of_pixel = |(x, y)| {
        let mut first: Vec<Words> = fragments(quads, x, y).iter().take(k as usize).map(PLAIN.words).collect();
        first.sort();
        first
    };
    pixels().map(of_pixel).collect()
}

#[test]
fn a_users_storage_keeps_the_same_words_on_both_devices() {
    let stage = device();
    for k in [1, 3, 8] {
        let variant = variant(k);
        let mut cpu = cpu_device::device(&variant, FragmentOrder::Submission);
        for language in ["wgsl", "spirv"] {
            let mut renderer = renderer(&stage, &shaders(&variant, language), &settings()).unwrap();
            for (name, quads) in cases() {
                for quads in orders(&quads).into_iter().take(4) {
                    let expected = first(&quads, k);
                    assert_eq!(
                        render_frame(&stage, &mut renderer, &quads).kept,
                        expected,
                        "{language}, k = {k}, {name}"
                    );
                    assert_eq!(cpu_device::draw(&mut cpu, &quads).0, expected, "the CPU device, k = {k}, {name}");
                }
            }
        }
    }
}
