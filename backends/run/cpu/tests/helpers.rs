//! Helper invocations beside the last column and row: they run, their writes have no effect, and every technique ends.

use std::sync::Arc;

use fragbuf_cpu::{Device, Error, FragmentOrder, Mesh, Settings};
use fragbuf_model::Draft;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Element, Pass, Resource, Step};

use crate::stage::{built_in_of, code, mesh, quad, storage};

const ORDERS: [FragmentOrder; 2] = [FragmentOrder::Submission, FragmentOrder::Shuffled(7)];

/// Counts fragments. A helper invocation in this column does not end.
const COUNT: &str = "
@fragment
fn count(inputs: FragmentInput) {
    let before = total_atomic_add(1u);
    while u32(inputs.position.x) == 5u {
        total_store(0u);
    }
}
";

/// Draws a quad over a frame of this size; returns the number of fragments that were counted.
fn count(width: u32, height: u32, order: FragmentOrder) -> Result<u32, Error> {
    let rows = storage(
        vec![Resource::new("total", Element::Word, "").cleared(0)],
        vec![Step::Pass(Pass::geometry("count", "count").uses("total", Access::Atomic))],
    );
    let code = code(rows, &[("count", COUNT)], None).unwrap_or_else(|error| panic!("{error}"));
    let mut device = Device::new(code, Settings { order, ..Settings::new(width, height) })?;
    let (vertices, indices) = mesh(&quad([0, 16, 0, 16], 0.5, [1.0; 4]));
    device.render(&Mesh { vertices: &vertices, indices: &indices }, &|_| {})?;
    Ok(device.words("total").unwrap()[0])
}

#[test]
fn helper_invocations_run_beside_the_last_column() {
    for order in ORDERS {
        let endless = count(5, 4, order);
        let Err(Error::NotTerminating { location: Some(location), .. }) = &endless else { panic!("{endless:?}") };
        let line = 1 + COUNT.lines().position(|line| line.contains("while ")).unwrap();
        assert_eq!(*location, format!("pass/count.wgsl:{line}"));
        assert_eq!(count(4, 5, order).unwrap(), 20, "helper invocations count nothing");
        assert_eq!(count(4, 4, order).unwrap(), 16);
    }
}

#[test]
fn every_technique_ends_at_odd_sizes() {
    let registry = Registry::builtin();
    let layers: Vec<_> = (0..6).flat_map(|at| quad([0, 16, 0, 16], 0.1 + 0.1 * at as f32, [0.5; 4])).collect();
    let (vertices, indices) = mesh(&layers);
    for technique in registry.techniques() {
        let key = technique.key.as_str();
        let draft = Draft::from_technique(key, &fragbuf_model::SourceSpan::new(key, 1, 1));
        let code = Arc::new(built_in_of(&draft, &registry));
        for (width, height) in [(5, 4), (4, 5), (5, 5), (1, 1), (17, 33)] {
            for order in ORDERS {
                let settings = Settings { order, ..Settings::new(width, height) };
                let mut device = Device::new(code.clone(), settings).unwrap();
                let picture = device.render(&Mesh { vertices: &vertices, indices: &indices }, &|_| {});
                let picture = picture.unwrap_or_else(|error| panic!("{key}, {width} x {height}: {error}"));
                assert!(picture.out_of_bounds.is_empty(), "{key}, {width} x {height}: {:?}", picture.out_of_bounds);
            }
        }
    }
}
