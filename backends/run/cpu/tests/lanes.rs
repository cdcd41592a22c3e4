//! Every technique in lanes and one invocation after the other: equal images, counters and words.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh, Picture, Settings};
use fragbuf_model::{Draft, SourceSpan};
use fragbuf_templates::Registry;

use crate::stage::{built_in_of, mesh, scattered, stacked};

/// Odd, narrow and several tiles.
const SIZES: [(u32, u32); 4] = [(5, 4), (1, 7), (17, 33), (35, 18)];

/// Renders on one thread, so that tiles reserve memory in the same order.
fn render(code: &Arc<Code>, settings: Settings, (vertices, indices): &(Vec<u32>, Vec<u32>)) -> (Device, Picture) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let mut device = Device::new(code.clone(), settings).unwrap();
        let picture = device.render(&Mesh { vertices, indices }, &|_| {}).unwrap();
        (device, picture)
    })
}

fn bits(picture: &Picture) -> Vec<[u32; 4]> {
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn lanes_change_no_word_of_any_technique() {
    let registry = Registry::builtin();
    let scenes = [mesh(&scattered(40, 9)), mesh(&stacked(24, 4))];
    for technique in registry.techniques() {
        let key = technique.key.as_str();
        let code = Arc::new(built_in_of(&Draft::from_technique(key, &SourceSpan::new(key, 1, 1)), &registry));
        for (width, height) in SIZES {
            for scene in &scenes {
                let settings = |lanes: bool| Settings { lanes, ..Settings::new(width, height) };
                let (in_lanes, seen) = render(&code, settings(true), scene);
                let (single, expected) = render(&code, settings(false), scene);
                let case = format!("{key}, {width} x {height}");
                assert!(bits(&seen) == bits(&expected), "{case}: the images differ");
                assert_eq!(seen.counters, expected.counters, "{case}");
                assert_eq!(seen.samples, expected.samples, "{case}");
                assert_eq!(seen.out_of_bounds, expected.out_of_bounds, "{case}");
                for planned in &single.plan().resources {
                    let name = &planned.resource.name;
                    assert!(in_lanes.words(name) == single.words(name), "{case}: words of {name} differ");
                }
            }
        }
    }
}
