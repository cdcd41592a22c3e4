//! Front-to-back peeling (Everitt 2001) by a depth test, a depth texture, two swapped resources and an occlusion count.

use fragbuf_cpu::{Code, FragmentOrder};
use fragbuf_frame::LoopEnd;
use fragbuf_templates::vocabulary::{Objects, Pass, Row, Step};
use std::sync::Arc;

use crate::peeling_loop::{BLEND, PEEL, peeling_loop, peeling_resources};
use crate::stage::{built_in, code, device, different, draw, scattered, stacked, storage};

/// Returns a storage row with the peeling loop. `before` is a pass before each peeling pass.
pub fn rows(at_most: &'static str, objects: Objects, before: Option<Pass>) -> Row {
    storage(peeling_resources(), vec![Step::Repeat(peeling_loop("peel", at_most, objects, before, "output"))])
}

/// Replaces the swap of resources by a copy.
fn copied(mut rows: Row) -> Row {
    if let Some(Step::Repeat(repeat)) = rows.steps.first_mut() {
        repeat.body.pop();
        repeat.body.push(Step::Copy { from: "next".to_owned(), to: "last".to_owned() });
    }
    rows
}

fn peeling(at_most: &'static str) -> Arc<Code> {
    code(rows(at_most, Objects::All, None), &[("peel", PEEL), ("blend", BLEND)], None).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn peeling_ends_when_no_fragment_is_left_and_gives_the_image() {
    let code = peeling("64");
    for (name, triangles) in [("stacked", stacked(12, 3)), ("scattered", scattered(9, 5))] {
        let expected = draw(&mut built_in("ab_ll"), &triangles);
        for order in [FragmentOrder::Submission, FragmentOrder::Shuffled(4)] {
            let mut device = device(&code, order);
            // A second frame starts from the same state.
            for _ in 0..2 {
                let seen = draw(&mut device, &triangles);
                assert_eq!(different(&seen.pixels, &expected.pixels, 1.0 / 128.0), 0, "{name}, {order:?}");
                let [report] = seen.loops.as_slice() else { panic!("one loop") };
                assert_eq!((report.until.as_str(), report.end), ("no sample passes in `peel`", LoopEnd::ConditionMet));
                assert!((3..64).contains(&report.iterations), "{name}: {report:?}");
                assert_eq!(seen.samples[0], 0, "no sample passes in the last iteration");
            }
        }
    }
}

#[test]
fn a_copy_gives_the_same_image_as_a_swap() {
    let triangles = stacked(12, 3);
    let expected = draw(&mut device(&peeling("64"), FragmentOrder::Submission), &triangles);
    let rows = copied(rows("64", Objects::All, None));
    let code = code(rows, &[("peel", PEEL), ("blend", BLEND)], None).unwrap_or_else(|error| panic!("{error}"));
    let seen = draw(&mut device(&code, FragmentOrder::Submission), &triangles);
    assert!(seen.pixels == expected.pixels && seen.loops == expected.loops);
}

#[test]
fn a_loop_that_reaches_its_limit_is_reported() {
    let triangles = stacked(12, 3);
    let expected = draw(&mut built_in("ab_ll"), &triangles);
    let seen = draw(&mut device(&peeling("2"), FragmentOrder::Submission), &triangles);
    assert_eq!((seen.loops[0].iterations, seen.loops[0].end), (2, LoopEnd::LimitReached));
    assert!(seen.samples[0] > 0, "the last iteration finds a layer");
    assert!(different(&seen.pixels, &expected.pixels, 1.0 / 128.0) > 20);
}
