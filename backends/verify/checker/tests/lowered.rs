//! Steps of frames that no built-in technique has: exchanged resources, copies, a loop that waits for samples, a host step
//! that reads many words and sets k. Without one of these steps, the same rows must fail.

use fragbuf_checker::{Model, Report};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Access, Edit, Element, Host, HostCall, HostFunction, Pass, Repeat, Resource, Row, Step, Template, Until,
};

use crate::subjects::{limits, report};

/// Stores in the first iteration, and discards in the second, which ends the loop. A third iteration would store everything
/// twice.
const STORE_ONCE: &str = "
@fragment
fn store(inputs: FragmentInput) {
    if frame.iteration == 1u {
        discard;
    }
    store_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

fn store_fragment(position: vec2<f32>, fragment: Fragment) {
    if !is_in_frame(position) || !admit(fragment) {
        return;
    }
    count_event(GENERATED);
    sync_store(pixel_index(position), fragment_pack(fragment));
}
";

const HISTOGRAM: &str = "
@compute @workgroup_size(64)
fn histogram(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if invocation.x < pixel_count() {
        let before = bins_atomic_add(min(counts_load(invocation.x), 15u), 1u);
    }
}
";

fn skeleton(key: &str, text: &'static str, calls: Vec<&'static str>) -> Row {
    let template = Some(Template::new(format!("pass/{key}.wgsl"), text));
    Row { template, calls, ..Row::new("pass", key, "", "") }
}

fn checked(registry: &Registry, key: &str, set: &[(&str, &str)]) -> Report {
    report(key, set, "wgsl", &limits(2, Model::Sequential), registry).unwrap()
}

/// Returns the list with its store pass in a loop.
fn repeated(until: Until) -> Registry {
    let builtin = Registry::builtin();
    let mut row = builtin.row("storage", "linked_list").unwrap().clone();
    let Step::Pass(store) = row.steps.remove(0) else { panic!("the list begins with its store pass") };
    let store = Step::Pass(Pass { skeleton: "store_once".to_owned(), ..store });
    row.steps.insert(0, Step::Repeat(Repeat::new(vec![store], until, "3")));
    let calls = vec!["addressing", "storage", "sync", "counters"];
    builtin.with(row).with(skeleton("store_once", STORE_ONCE, calls))
}

#[test]
fn a_loop_waits_for_the_samples_of_the_fragments_under_test() {
    let found = checked(&repeated(Until::NoSamples("store".to_owned())), "ab_ll", &[]);
    assert!(found.failure.is_none() && found.is_exhaustive, "{:?}", found.failure);
    let found = checked(&repeated(Until::Times("3".into())), "ab_ll", &[]);
    assert!(found.failure.is_some(), "a third iteration stores everything twice");
}

#[test]
fn a_pass_that_stores_outside_of_the_frame_fails() {
    let registry = repeated(Until::NoSamples("store".to_owned()));
    let unguarded = STORE_ONCE.replace("!is_in_frame(position) || ", "");
    let mut row = registry.row("pass", "store_once").unwrap().clone();
    row.template = Some(Template::new("pass/store_once.wgsl", unguarded));
    let failure = checked(&registry.with(row), "ab_ll", &[]).failure.unwrap();
    assert!(failure.case.contains("outside of the frame"), "{failure:?}");
}

/// Returns the list with its heads exchanged with another buffer while fragments are stored, and then copied back.
fn exchanged(copies: &[(&str, &str)]) -> Registry {
    let builtin = Registry::builtin();
    let mut row = builtin.row("storage", "linked_list").unwrap().clone();
    row.resources.push(Resource::new("others", Element::Word, "").by("pixel", "pixels").cleared(0));
    let swap = || Step::Swap("heads".to_owned(), "others".to_owned());
    let copy = |(from, to): &(&str, &str)| Step::Copy { from: (*from).to_owned(), to: (*to).to_owned() };
    row.steps.insert(0, swap());
    row.steps.splice(2..2, std::iter::once(swap()).chain(copies.iter().map(copy)));
    builtin.with(row)
}

#[test]
fn exchanged_resources_replace_each_other() {
    let found = checked(&exchanged(&[("others", "heads")]), "ab_ll", &[]);
    assert!(found.failure.is_none() && found.is_exhaustive, "{:?}", found.failure);
    let found = checked(&exchanged(&[]), "ab_ll", &[]);
    assert!(found.failure.is_some(), "the resolve pass reads the empty heads");
}

/// Returns rows whose host function sets k from a histogram of fragments per pixel.
fn registry_of(function: fn(&HostCall<'_>) -> Result<Vec<u64>, String>) -> Registry {
    let histogram = Pass::compute("histogram", "histogram", "ceil_div(pixels, 64)", "1")
        .uses("counts", Access::Read)
        .uses("bins", Access::Atomic);
    let decide = Host::new("decide").reads_all("bins").sets("k");
    let row = Row {
        edits: vec![
            Edit::AddResource(Resource::new("bins", Element::Word, "").by("bin", "16").cleared(0)),
            Edit::After("count".to_owned(), vec![Step::Pass(histogram), Step::Host(decide)]),
        ],
        ..Row::new("select", "by_histogram", "", "")
    };
    let host = Row { host: Some(HostFunction(function)), ..Row::new("host", "decide", "", "") };
    Registry::builtin().with(row).with(host).with(skeleton("histogram", HISTOGRAM, vec!["addressing"]))
}

fn deepest(call: &HostCall<'_>) -> u64 {
    call.reads[0].iter().rposition(|pixels| *pixels > 0).map_or(0, |bin| bin as u64)
}

#[test]
fn a_host_step_reads_a_histogram_and_sets_k() {
    let set = [("select", "by_histogram")];
    for function in [
        |call: &HostCall<'_>| Ok(vec![deepest(call).max(1)]),
        |call: &HostCall<'_>| Ok(vec![(deepest(call) / 2).max(1)]),
    ] {
        let found = checked(&registry_of(function), "kplus_ab_sb", &set);
        assert!(found.failure.is_none() && found.is_exhaustive, "{:?}", found.failure);
    }
    let variant = crate::subjects::variant("kplus_ab_sb", &set, &registry_of(|_| Ok(vec![99]))).unwrap();
    let registry = registry_of(|_| Ok(vec![99]));
    let beyond = fragbuf_checker::check_variant(
        &variant,
        crate::subjects::target("wgsl"),
        &registry,
        &limits(2, Model::Sequential),
        &mut |_| {},
    );
    assert!(format!("{beyond:?}").contains("sets to 99, must be from 1 to 8"), "{beyond:?}");
}
