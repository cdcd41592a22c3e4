//! Plans that are rejected, and their error messages.

use fragbuf_cpu::{Error, FragmentOrder, Mesh};
use fragbuf_templates::vocabulary::{
    Access, Blend, Coverage, Element, Host, Objects, Pass, Repeat, Resource, Row, Samples, Step, TextureFormat, Until,
};

use crate::stage::{code, device, picture, storage, texture};

/// Declares a texture of floats, whatever its format in the plan is.
const BLEND: &str = "
@group(0) @binding(peeled) var floats: texture_2d<f32>;

@fragment
fn blend(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(floats, vec2<u32>(position.xy), 0);
}
";

fn error_of(rows: Row, skeletons: &[(&str, &str)]) -> String {
    let code = match code(rows, skeletons, None) {
        Ok(code) => code,
        Err(error) => return error.to_string(),
    };
    let mut device = device(&code, FragmentOrder::Submission);
    let drawn: Result<_, Error> = device.render(&Mesh { vertices: &[], indices: &[] }, &|_| {});
    drawn.map_or_else(|error| error.to_string(), |_| "nothing".to_owned())
}

/// Returns a storage with three textures; the pass reads the third, which has this format.
fn read(format: TextureFormat, pass: Pass) -> Row {
    let layer = |name: &str, format| texture(name, format);
    let any = TextureFormat::R32Float;
    storage(vec![layer("a", any), layer("b", any), layer("peeled", format)], vec![Step::Pass(pass)])
}

#[test]
fn a_pass_does_not_read_a_texture_that_it_draws_to() {
    let pass = Pass::fullscreen("blend", "blend").uses("peeled", Access::Sampled).target("peeled", Blend::Over);
    let seen = error_of(read(TextureFormat::Rgba8Unorm, pass), &[("blend", BLEND)]);
    assert!(seen.contains("pass `blend`: `peeled`, which it both reads and draws to"), "{seen}");
}

#[test]
fn texture_declarations_match_the_plan() {
    let pass = || picture("blend").uses("peeled", Access::Sampled);
    let seen = error_of(read(TextureFormat::R32Uint, pass()), &[("blend", BLEND)]);
    assert!(seen.contains("the texture `floats`: its declaration does not match the format R32Uint"), "{seen}");
    let several = Resource::new("peeled", Element::Texture(TextureFormat::Rgba8Unorm), "")
        .by("sample", "4")
        .by("pixel", "pixels");
    let mut rows = read(TextureFormat::Rgba8Unorm, pass());
    rows.resources[2] = several;
    let seen = error_of(rows, &[("blend", BLEND)]);
    assert!(seen.contains("the plan has 4 samples, and the declaration does not match"), "{seen}");
    let mut rows = read(TextureFormat::Rgba8Unorm, pass());
    rows.resources[2] = Resource::new("peeled", Element::Word, "").by("pixel", "pixels");
    let seen = error_of(rows, &[("blend", BLEND)]);
    assert!(seen.contains("the plan has a buffer at this binding"), "{seen}");
}

#[test]
fn only_resources_of_equal_shape_are_exchanged() {
    let rows = |step: Step| {
        let words = Resource::new("words", Element::Word, "").by("pixel", "pixels");
        storage(
            vec![words, texture("texels", TextureFormat::R32Uint), texture("pairs", TextureFormat::Rg32Float)],
            vec![step],
        )
    };
    for (a, b) in [("words", "texels"), ("texels", "pairs")] {
        let seen = error_of(rows(Step::Swap(a.to_owned(), b.to_owned())), &[]);
        assert!(
            seen.contains(&format!("`{a}` cannot be copied to or exchanged with `{b}`: their shapes differ")),
            "{seen}"
        );
        let seen = error_of(rows(Step::Copy { from: a.to_owned(), to: b.to_owned() }), &[]);
        assert!(seen.contains("their shapes differ"), "{seen}");
    }
}

#[test]
fn indirect_arguments_are_long_enough_and_for_one_draw() {
    const NOTHING: &str = "
@fragment
fn nothing() {}
";
    let rows = |words: &'static str, objects: Objects| {
        let arguments = Resource::new("arguments", Element::Word, "").by("word", words);
        let pass = Pass::geometry("nothing", "nothing").uses("arguments", Access::Indirect);
        let boxes = Pass { objects: Objects::Boxes, ..Pass::geometry("boxes", "nothing") };
        storage(vec![arguments], vec![Step::Pass(boxes), Step::Pass(Pass { objects, ..pass })])
    };
    let seen = error_of(rows("4", Objects::All), &[("nothing", NOTHING)]);
    assert!(seen.contains("`arguments` as indirect arguments: it has 4 words, but needs 5"), "{seen}");
    let seen = error_of(rows("5", Objects::Visible("boxes".to_owned())), &[("nothing", NOTHING)]);
    assert!(seen.contains("indirect arguments for several objects"), "{seen}");
}

#[test]
fn loops_and_objects_name_existing_passes() {
    let rows = |until: Until| {
        let body = vec![Step::Clear { resource: "words".to_owned(), value: 0 }];
        let words = Resource::new("words", Element::Word, "").by("pixel", "pixels");
        storage(vec![words], vec![Step::Repeat(Repeat::new(body, until, "2"))])
    };
    let seen = error_of(rows(Until::NoSamples("missing".to_owned())), &[]);
    assert!(seen.contains("the samples of `missing`, which is not a pass of its body"), "{seen}");
    let repeat = |at_most: &'static str| Repeat::new(Vec::new(), Until::Times("1".into()), at_most);
    let seen = error_of(
        storage(vec![], vec![Step::Repeat(Repeat { until: Until::Times("iteration".into()), ..repeat("1") })]),
        &[],
    );
    assert!(seen.contains("the limit of a loop depends on `iteration`"), "{seen}");
    let blind = Pass { objects: Objects::Visible("seen".to_owned()), ..Pass::geometry("seen", "seen") };
    let seen = error_of(storage(vec![], vec![Step::Pass(blind)]), &[]);
    assert!(seen.contains("visible in `seen`, which is not a pass that draws boxes"), "{seen}");
    let mut sampled = Pass::geometry("several", "several");
    sampled.state.samples = Some(Samples { count: "k".into(), mask: "1".into(), coverage: Coverage::PerSample });
    let seen = error_of(storage(vec![], vec![Step::Pass(sampled)]), &[]);
    assert!(seen.contains("its samples depend on `k`"), "{seen}");
    let seen = error_of(rows(Until::WordIsZero("missing".to_owned())), &[]);
    assert!(seen.contains("`missing`, which the plan does not have"), "{seen}");
}

#[test]
fn unsupported_steps_are_named() {
    let words = |name: &str| Resource::new(name, Element::Word, "").by("pixel", "pixels");
    let rows = |steps: Vec<Step>| {
        let resources = vec![words("a"), words("b"), words("c"), texture("texels", TextureFormat::R32Uint)];
        storage(resources, steps)
    };
    let swap = |a: &str, b: &str| Step::Swap(a.to_owned(), b.to_owned());
    let until = Until::WordIsZero("texels".to_owned());
    let nothing = Step::Clear { resource: "a".to_owned(), value: 0 };
    let cases = [
        (
            vec![swap("a", "b"), swap("b", "c")],
            "are exchanged: a resource can be exchanged with only one other resource",
        ),
        (vec![swap("a", "a")], "are exchanged: a resource can be exchanged with only one other resource"),
        (vec![Step::Clear { resource: "missing".to_owned(), value: 0 }], "a step names `missing`"),
        (vec![Step::Host(Host::new("meditate"))], "the host function `meditate`, which does not exist"),
        (vec![Step::Host(Host::new("allocate").sets("width"))], "sets `width`, which host functions cannot set"),
        (vec![Step::Host(Host::new("allocate").reads_all("texels"))], "a step reads `texels`, which is not one buffer"),
        (vec![Step::Host(Host::new("allocate").reads_word("a", "unknown"))], "`unknown` has no value yet"),
        (vec![Step::Repeat(Repeat::new(vec![nothing], until, "2"))], "`texels`, which is not one buffer"),
    ];
    for (steps, expected) in cases {
        let seen = error_of(rows(steps), &[]);
        assert!(seen.contains(expected), "{seen}");
    }
}

/// A host step reads only words of the buffer, and sets only values within the range of a symbol.
#[test]
fn a_host_step_stays_within_its_bounds() {
    let words = || Resource::new("words", Element::Word, "").by("slot", "n").by("pixel", "pixels").cleared(0);
    let rows = |host: Host| storage(vec![words()], vec![Step::Host(host)]);
    let seen = error_of(rows(Host::new("allocate").reads_some("words", "1", "1 << 2").sets("n")), &[]);
    assert!(seen.contains("is not a formula"), "{seen}");
    let seen = error_of(rows(Host::new("allocate").reads_word("words", "4096 * 4096").sets("n")), &[]);
    assert!(seen.contains("reads of `words`, words 16777216 to 16777216, must be within its"), "{seen}");
    let eleven = || Resource::new("eleven", Element::Word, "").by("word", "1").cleared(0);
    let host = Host::new("allocate").reads_word("eleven", "0").sets("k");
    let seen = error_of(storage(vec![eleven()], vec![Step::Host(host)]), &[]);
    assert!(seen.contains("`k`, which the host function `allocate` sets to 0, must be from 1 to 64"), "{seen}");
}
