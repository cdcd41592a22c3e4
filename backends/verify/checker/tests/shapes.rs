//! Public shapes: small shaders after published algorithms, most with a twin that has the classic mistake. The first line of each
//! file has the verdicts, which follow from the memory models as its second line explains.

use std::path::PathBuf;

use fragbuf_checker::{Limits, Model, Report, Shader, check_shader};

/// A file of `tests/shapes`.
#[derive(Clone)]
struct Shape {
    name: String,
    source: String,
    entry: String,
    invocations: Vec<u32>,
    fill: Vec<(String, Vec<u32>)>,
    /// The verdicts under sequential consistency and relaxed memory.
    expected: [String; 2],
}

fn shapes() -> Vec<Shape> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/shapes");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
        .iter()
        .map(|path| shape(path.file_name().unwrap().to_str().unwrap(), std::fs::read_to_string(path).unwrap()))
        .collect()
}

fn shape(name: &str, source: String) -> Shape {
    let (head, why) = (source.lines().next().unwrap(), source.lines().nth(1).unwrap());
    assert!(why.starts_with("// why: "), "{name}");
    let field = |name: &str| {
        let fields = head.trim_start_matches("// ").split("; ").filter_map(|field| field.split_once(": "));
        fields.filter(|(key, _)| *key == name).map(|(_, value)| value.to_owned()).next()
    };
    let filled = |text: String| {
        let (name, words) = text.split_once('=').unwrap();
        (name.to_owned(), words.split(',').map(|word| word.parse().unwrap()).collect())
    };
    Shape {
        name: name.to_owned(),
        entry: field("entry").unwrap(),
        fill: field("fill").map(filled).into_iter().collect(),
        invocations: field("fragments").unwrap().split(',').map(|count| count.parse().unwrap()).collect(),
        expected: [field("sc").unwrap(), field("relaxed").unwrap()],
        source,
    }
}

/// Returns the verdict in one word.
fn verdict(report: &Report) -> &'static str {
    let Some(failure) = &report.failure else { return if report.is_exhaustive { "holds" } else { "undecided" } };
    let kinds = [
        ("data race", "race"),
        ("deadlock", "deadlock"),
        ("livelock", "livelock"),
        ("divergent barrier", "barrier"),
        ("loops without end", "endless"),
        ("`holds` returns false", "wrong"),
    ];
    kinds.iter().find(|(text, _)| failure.violation.contains(text)).map_or("another", |(_, kind)| kind)
}

fn check(shape: &Shape, model: Model, reduce: bool) -> Report {
    let shader = Shader {
        file: &shape.name,
        source: &shape.source,
        entry: &shape.entry,
        fill: &shape.fill,
        ..Shader::default()
    };
    let limits = Limits { fragments: shape.invocations.clone(), model, reduce, ..Limits::default() };
    check_shader(&shader, &limits).unwrap_or_else(|error| panic!("{}: {error:?}", shape.name))
}

#[test]
fn every_shape_has_its_verdict() {
    let shapes = shapes();
    assert!(shapes.len() > 100);
    for shape in &shapes {
        for (model, expected) in [Model::Sequential, Model::Relaxed].into_iter().zip(&shape.expected) {
            let report = check(shape, model, true);
            assert_eq!(verdict(&report), expected, "{} {model:?}: {:#?}", shape.name, report.failure);
        }
    }
    let kinds = |kind: &str| shapes.iter().filter(|shape| shape.expected[1] == kind).count();
    assert!(kinds("holds") > 39 && kinds("race") > 30 && kinds("wrong") > 15 && kinds("deadlock") > 4);
}

/// Workgroups, barriers and two memory spaces are new to the reduction, too.
#[test]
fn shapes_have_the_same_verdict_without_the_reduction() {
    for shape in shapes().iter().filter(|shape| shape.name.starts_with("wg_") || shape.name.starts_with("lo")) {
        let two = Shape { invocations: vec![2], ..shape.clone() };
        for model in [Model::Sequential, Model::Relaxed] {
            let (reduced, all) = (check(&two, model, true), check(&two, model, false));
            assert_eq!(verdict(&reduced), verdict(&all), "{} {model:?}", shape.name);
        }
    }
}

/// Both accesses of a race, with their lines, and the word by its declared name.
#[test]
fn a_race_names_its_word_and_both_places() {
    let source = "struct Node { key: u32, color: vec2<u32> }
struct Heads { count: atomic<u32>, nodes: array<Node> }
@group(0) @binding(0) var<storage, read_write> heads: Heads;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x == 0u {
        heads.nodes[3].color.y = 7u;
    } else {
        let color = heads.nodes[3].color.y;
        atomicAdd(&heads.count, color);
    }
}";
    let shader = Shader { file: "nodes.wgsl", source, entry: "main", ..Shader::default() };
    for model in [Model::Sequential, Model::Relaxed] {
        let report = check_shader(&shader, &Limits { model, ..Limits::default() }).unwrap();
        let failure = report.failure.unwrap();
        let race = failure.race.unwrap();
        assert_eq!(race.word, "heads.nodes[3].color.y");
        let mut places = [race.first.location, race.second.location];
        places.sort();
        assert_eq!(places, ["nodes.wgsl:6", "nodes.wgsl:8"]);
        assert!(
            failure.violation.starts_with("data race on heads.nodes[3].color.y: A writes"),
            "{}",
            failure.violation
        );
    }
}

/// Words of workgroup variables have the number of their workgroup, and workgroups do not share them.
#[test]
fn workgroups_have_their_own_variables() {
    let source = "var<workgroup> tile: array<u32, 2>;
@group(0) @binding(0) var<storage, read_write> sums: array<u32, 4>;
@compute @workgroup_size(2)
fn main(@builtin(local_invocation_index) local: u32, @builtin(workgroup_id) group: vec3<u32>) {
    tile[local] = local + 1u + 10u * group.x;
    BARRIER
    sums[2u * group.x + local] = tile[0] + tile[1];
}
fn holds() -> bool {
    return sums[0] == 3u && sums[1] == 3u && (sums[2] == 0u || sums[2] == 23u && sums[3] == 23u);
}";
    for model in [Model::Sequential, Model::Relaxed] {
        let limits = Limits { model, ..Limits::default() };
        let run = |barrier: &str| {
            let source = source.replace("BARRIER", barrier);
            check_shader(&Shader { file: "tile.wgsl", source: &source, entry: "main", ..Shader::default() }, &limits)
                .unwrap()
        };
        assert_eq!(run("workgroupBarrier();").failure, None);
        // It orders storage buffers only.
        for barrier in ["", "storageBarrier();"] {
            let failure = run(barrier).failure.unwrap();
            assert!(failure.race.unwrap().word.ends_with(" of workgroup 0"), "{}", failure.violation);
        }
    }
}

/// A part of a large workgroup runs, which the report states.
#[test]
fn a_part_of_a_large_workgroup_is_stated() {
    let source = "@group(0) @binding(0) var<storage, read_write> n: atomic<u32>;
override size = 8u;
@compute @workgroup_size(size * 8u) fn main() { workgroupBarrier(); atomicAdd(&n, size); }
fn holds() -> bool { return atomicLoad(&n) % size == 0u; }";
    let shader = Shader { file: "large.wgsl", source, entry: "main", ..Shader::default() };
    let report = check_shader(&shader, &Limits::default()).unwrap();
    assert_eq!((report.failure, report.cases), (None, 4));
    assert!(report.notes.iter().any(|note| note.starts_with("2 of the 64 invocations")), "{:?}", report.notes);
    // What all invocations would do is not known.
    let all = source.replace("% size == 0u", "== 64u * size");
    let report = check_shader(&Shader { source: &all, ..shader }, &Limits::default()).unwrap();
    assert_eq!((report.failure, report.is_exhaustive), (None, false));
    assert!(report.notes.iter().any(|note| note.contains("this decides nothing")), "{:?}", report.notes);
    let small = Shader { overrides: &[("size".to_owned(), 0.25)], ..shader };
    assert!(check_shader(&small, &Limits::default()).is_err(), "0.25 is no value of a u32");
    let other = Shader { overrides: &[("sise".to_owned(), 1.0)], ..shader };
    assert!(check_shader(&other, &Limits::default()).is_err());
}

/// Sources that a review found to pass or to fail wrongly, with the verdict under both models.
#[test]
fn faults_of_a_review_stay_corrected() {
    const HEAD: &str = "
@group(0) @binding(0) var<storage, read_write> x: u32;
@group(0) @binding(1) var<storage, read_write> y: array<u32, 2>;
@group(3) @binding(1000000) var<storage, read_write> flag: atomic<u32>;
@group(1) @binding(0) var<storage, read> wide: array<u64, 2>;
@group(1) @binding(1) var<storage, read_write> d: u32;
fn memory_fence() {}
";
    // A barrier before a read orders nothing after it; workgroupBarrier orders no storage buffer.
    let barrier = "@compute @workgroup_size(2) fn main(@builtin(local_invocation_index) id: u32) {
        storageBarrier();
        if id == 0u { y[0] = x; }
        workgroupBarrier();
        if id == 1u { x = 1u; }
    }";
    let fence = "@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        if id.x == 0u { memory_fence(); y[0] = x; atomicStore(&flag, 1u); return; }
        if atomicLoad(&flag) == 1u { memory_fence(); x = 1u; }
    }";
    // The loop ends by its counter alone, so it does not wait.
    let sampling = "@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        if id.x == 0u { d = 1u; atomicStore(&flag, 1u); return; }
        var seen = 0u;
        for (var i = 0u; i < 64u; i++) { seen = atomicLoad(&flag); }
        d = 2u + seen;
    }";
    // A load before the five stores is an interleaving of its own.
    let stores = "@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        if id.x == 0u { for (var i = 0u; i < 5u; i++) { atomicStore(&flag, 1u); } d = 1u; return; }
        if atomicLoad(&flag) == 0u { d = 2u; }
    }";
    let wide = "@compute @workgroup_size(1) fn main() { if wide[0] != 0lu { atomicStore(&flag, 1u); } }
        fn holds() -> bool { return atomicLoad(&flag) == 0u; }";
    let long = "@compute @workgroup_size(1) fn main() {
        for (var i = 0u; i < 17000000u; i++) {}
        atomicStore(&flag, 1u);
    }";
    let scratch = "@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) { atomicStore(&flag, id.x); }
        fn holds() -> bool { y[0] += 1u; return y[0] == 1u && d == 0u; }";
    for (source, fill, [sequential, relaxed]) in [
        (barrier, &[][..], ["race", "race"]),
        (fence, &[], ["holds", "race"]),
        (sampling, &[], ["race", "race"]),
        (stores, &[], ["race", "race"]),
        (wide, &[("wide".to_owned(), vec![5, 0, 6, 0])], ["wrong", "wrong"]),
        (long, &[], ["undecided", "undecided"]),
        (scratch, &[], ["holds", "holds"]),
    ] {
        let source = format!("{HEAD}{source}");
        for (model, expected) in [(Model::Sequential, sequential), (Model::Relaxed, relaxed)] {
            let shader = Shader { file: "fault.wgsl", source: &source, entry: "main", fill, ..Shader::default() };
            let report = check_shader(&shader, &Limits { fragments: vec![2], model, ..Limits::default() }).unwrap();
            assert_eq!(verdict(&report), expected, "{model:?} {source} {:#?}", report.failure);
        }
    }
}

/// Nothing that a file contains ends in a panic, a stack overflow or more memory than a check has.
#[test]
fn extreme_sources_are_rejected() {
    let head = "@group(0) @binding(0) var<storage, read_write> n: atomic<u32>;\n";
    let main = |body: &str| format!("{head}@compute @workgroup_size(1) fn main() {{ let x = atomicLoad(&n); {body} }}");
    let sum = vec!["x"; 100_000].join(" + ");
    let branches: String =
        (0..20_000).map(|number| format!(" else if x == {number}u {{ atomicAdd(&n, 2u); }}")).collect();
    let calls: String = (0..40)
        .map(|number| format!("fn f{}() -> u32 {{ return f{number}() + f{number}(); }}\n", number + 1))
        .collect();
    for source in [
        main(&format!("atomicAdd(&n, {sum});")),
        main(&format!("if x == 7u {{ atomicAdd(&n, 1u); }}{branches}")),
        format!("fn f0() -> u32 {{ return atomicLoad(&n); }}\n{calls}{}", main("atomicAdd(&n, f40());")),
        format!("var<private> p: array<u32, 400000000>;\n{}", main("p[x] = 1u; atomicAdd(&n, p[x + 1u]);")),
        format!("var<workgroup> p: array<u32, 400000000>;\n{}", main("p[x] = 1u; atomicAdd(&n, p[x + 1u]);")),
        main("var p: array<u32, 400000000>; p[x] = 1u; atomicAdd(&n, p[x + 1u]);"),
        format!(
            "struct S {{ a: atomic<u32>, b: u32 }}\n@group(1) @binding(0) var<storage, read_write> s: array<S, 100000000>;\n{}",
            main("atomicAdd(&s[x].a, 1u);")
        ),
        main("").replace("@workgroup_size(1)", "@workgroup_size(0)"),
        format!("{}fn holds(x: u32) -> bool {{ return true; }}", main("")),
        format!("{}fn holds() -> u32 {{ return 1u; }}", main("")),
        format!("var<workgroup> w: u32;\n{}fn holds() -> bool {{ return w == 0u; }}", main("w = 1u;")),
        format!("var<workgroup> w: array<bool, 4>;\n{}", main("w[x] = true;")),
    ] {
        let shader = Shader { file: "extreme.wgsl", source: &source, entry: "main", ..Shader::default() };
        let result = check_shader(&shader, &Limits::default());
        assert!(result.is_err(), "{}", source.get(..300).unwrap_or(&source));
    }
}
