//! `fragbuf generate --bindings c`: headers compile as C11 and C++17, and their values are those of the plan and of the manifest.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::load::{Description, variant};
use fragbuf::{Form, Generation, Plan, Registry, Request, Variant, generate, manifest, target};
use fragbuf_codegen::SymbolId;
use fragbuf_frame::{Values, host_sets_k, resource_bytes};
use fragbuf_targets::{c_header, c_name};
use serde_json::Value;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn folder(name: &str) -> PathBuf {
    crate::render::folder(&format!("c-{name}"))
}

fn fragbuf(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap()
}

/// Compiles a program in a folder. Every warning is an error.
fn cc(folder: &Path, language: &[&str], arguments: &[&str]) {
    let warnings = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-I", "."];
    let output = Command::new("cc").args(language).args(warnings).args(arguments).current_dir(folder).output();
    let output = output.unwrap_or_else(|error| panic!("cc, a compiler for C and C++, is needed: {error}"));
    assert!(output.status.success(), "{language:?}: {}", String::from_utf8_lossy(&output.stderr));
}

const C: &[&str] = &["-std=c11"];
const CPP: &[&str] = &["-x", "c++", "-std=c++17"];

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn generated(variant: &Variant, targets: &[&str], group: u32) -> Generation {
    generated_in(Form::Program, variant, targets, group)
}

fn generated_in(form: Form, variant: &Variant, targets: &[&str], group: u32) -> Generation {
    let targets: Vec<_> = targets.iter().map(|name| target(name).unwrap()).collect();
    let request = Request { targets: &targets, form, prefix: "", group };
    generate(variant, &request, &Registry::builtin()).unwrap_or_else(|errors| panic!("{errors}"))
}

/// The sizes of frames, and the fragments that they have memory for.
const SIZES: [(u32, u32, u64); 3] = [(1, 1, 1), (65, 33, 10_007), (1920, 1080, 40_000_000)];

/// Prints what the tables of a plan say, one line per fact.
const FACTS: &str = r#"
static void facts(const char *name, const struct fragbuf_plan *plan, const struct fragbuf_symbols *symbols)
{
    for (uint32_t i = 0; i < plan->resource_count; i++) {
        const struct fragbuf_resource *one = &plan->resources[i];
        printf("%s bytes %s %llu\n", name, one->name, (unsigned long long)one->bytes(symbols));
    }
}

static const char *actions[] = {"clear", "copy", "pass", "loop", "loop_end", "host"};

static void tables(const char *name, const struct fragbuf_plan *plan, const struct fragbuf_symbols *symbols)
{
    for (uint32_t i = 0; i < plan->block_count; i++) {
        const struct fragbuf_block *one = &plan->blocks[i];
        printf("%s block %s %u %u %u\n", name, one->name, one->binding, one->opengl_binding, one->bytes);
    }
    for (uint32_t i = 0; i < plan->resource_count; i++) {
        const struct fragbuf_resource *one = &plan->resources[i];
        printf("%s resource %s %u %u\n", name, one->name, one->binding, one->opengl_binding);
    }
    for (uint32_t i = 0; i < plan->vertex_input_count; i++) {
        printf("%s input %s %s %u\n", name, plan->vertex_inputs[i].name, plan->vertex_inputs[i].type, plan->vertex_inputs[i].location);
    }
    for (uint32_t i = 0; i < plan->file_count; i++) {
        const struct fragbuf_file *one = &plan->files[i];
        printf("%s file %s %s %s %s\n", name, one->path, plan->passes[one->pass].name, one->stage, one->entry_point);
    }
    for (uint32_t i = 0; i < plan->counter_count; i++) {
        printf("%s counter %s %u\n", name, plan->counters[i].name, plan->counters[i].is_loss);
    }
    for (uint32_t i = 0; i < plan->step_count; i++) {
        const struct fragbuf_step *one = &plan->steps[i];
        printf("%s step %s", name, actions[one->action]);
        switch (one->action) {
        case FRAGBUF_CLEAR: printf(" %s %u", plan->resources[one->index].name, one->value); break;
        case FRAGBUF_COPY: printf(" %s %s", plan->resources[one->index].name, plan->resources[one->value].name); break;
        case FRAGBUF_PASS: printf(" %s", plan->passes[one->index].name); break;
        case FRAGBUF_LOOP: printf(" %u", plan->loops[one->index].end); break;
        case FRAGBUF_LOOP_END: printf(" %u", plan->loops[one->index].begin); break;
        case FRAGBUF_HOST: printf(" %s", plan->hosts[one->index].function); break;
        }
        for (uint32_t pair = 0; one->parities && pair < plan->exchange_count; pair++) {
            printf(" %u:%llu", one->parities[pair].is_odd, (unsigned long long)one->parities[pair].loops);
        }
        printf("\n");
    }
    for (uint32_t i = 0; i < plan->pass_count; i++) {
        if (plan->passes[i].kind == FRAGBUF_COMPUTE) {
            printf("%s groups %s", name, plan->passes[i].name);
            for (int axis = 0; axis < 3; axis++) {
                printf(" %llu", (unsigned long long)plan->passes[i].groups[axis](symbols));
            }
            printf("\n");
        }
    }
    for (uint32_t i = 0; i < plan->loop_count; i++) {
        printf("%s loop %llu\n", name, (unsigned long long)plan->loops[i].max_iterations(symbols));
    }
}
"#;

/// Returns the values of a plan for a size, with k set if it is given.
fn values(plan: &Plan, (width, height, fragments): (u32, u32, u64), k: u32) -> Values {
    let values = Values::new(plan, (width, height)).with(SymbolId::K, k.into());
    values.with(SymbolId::FRAGMENTS, fragments).with(SymbolId::KEPT, fragments)
}

/// Returns the lines of [`FACTS`] for the tables, from the manifest and the plan.
fn expected(name: &str, json: &Value, files: &Value, plan: &Plan) -> Vec<String> {
    let mut lines = Vec::new();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let word = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let mut add = |what: &str, words: &[&Value]| {
        let words: Vec<String> = words.iter().map(|value| word(value)).collect();
        lines.push(format!("{name} {what} {}", words.join(" ")));
    };
    for block in list(&json["uniform_blocks"]) {
        add("block", &[&block["name"], &block["binding"], &block["opengl_binding"], &block["bytes"]]);
    }
    for one in list(&json["resources"]) {
        // A resource that no shader declares has no binding point.
        let point = one["opengl_binding"].as_u64().unwrap_or(u32::MAX.into()).into();
        add("resource", &[&one["name"], &one["binding"], &point]);
    }
    for one in list(&json["vertex_inputs"]) {
        add("input", &[&one["name"], &one["type"], &one["location"]]);
    }
    for one in list(files) {
        add("file", &[&one["path"], &one["pass"], &one["stage"], &one["entry_point"]]);
    }
    for one in list(&json["counters"]) {
        add("counter", &[&one["name"], &u32::from(one["is_loss"] == true).into()]);
    }
    let at_most = values(plan, SIZES[1], plan.capacity());
    for (step, command) in list(&json["steps"]).iter().zip(&plan.frame.commands) {
        let kind = step["do"].as_str().unwrap();
        let words: &[&str] = match kind {
            "clear" => &["resource", "value"],
            "copy" => &["from", "to"],
            "pass" => &["pass"],
            "loop" => &["end"],
            "loop_end" => &["begin"],
            _ => &["function"],
        };
        let words: Vec<String> = words.iter().map(|name| format!(" {}", word(&step[*name]))).collect();
        let is_plain = command.parities.iter().all(|parity| !parity.is_odd && parity.loops.is_empty());
        let mask = |parity: &fragbuf_codegen::Parity| parity.loops.iter().map(|id| 1_u64 << id.0).sum::<u64>();
        let parities = command.parities.iter().filter(|_| !is_plain);
        let parities: String =
            parities.map(|parity| format!(" {}:{}", u32::from(parity.is_odd), mask(parity))).collect();
        lines.push(format!("{name} step {kind}{}{parities}", words.concat()));
    }
    let value = |quantity| at_most.evaluate(quantity, "a formula").unwrap().to_string();
    for pass in plan.passes.iter().filter(|pass| !pass.groups.is_empty()) {
        let groups: Vec<String> = pass.groups.iter().map(value).collect();
        lines.push(format!("{name} groups {} {}", pass.name, groups.join(" ")));
    }
    lines.extend(plan.frame.loops.iter().map(|looped| format!("{name} loop {}", value(&looped.max_iterations))));
    lines
}

/// Every technique for two targets, in one program: sizes are those of the frame, everything else is that of the manifest.
#[test]
fn headers_of_every_technique_have_the_values_of_their_plans() {
    let folder = folder("techniques");
    let registry = Registry::builtin();
    let (mut includes, mut asserts, mut calls, mut lines) = (String::new(), String::new(), String::new(), Vec::new());
    for (number, technique) in registry.techniques().iter().enumerate() {
        let (key, group) = (technique.key.as_str(), number as u32 % 4);
        let variant = variant(&Description::Technique(key.to_owned()), &[], &registry);
        let generation =
            generated(&variant.unwrap_or_else(|errors| panic!("{errors}")), &["wgsl-native", "glsl-vulkan"], group);
        let stem = c_name(key);
        std::fs::write(folder.join(format!("{stem}.h")), c_header(&generation, key, key, group)).unwrap();
        includes += &format!("#include \"{stem}.h\"\n");
        let json = manifest(&generation, group);
        for (index, planned) in generation.plans.iter().enumerate() {
            let plan = &planned.plan;
            let base = if index == 0 { stem.clone() } else { format!("{stem}_plan_{index}") };
            let part = if index == 0 { &json } else { &json["alternatives"][index - 1] };
            let is_own = |file: &&Value| planned.targets.iter().any(|target| file["target"] == target.name);
            let files: Value = json["files"].as_array().unwrap().iter().filter(is_own).cloned().collect();
            for block in part["uniform_blocks"].as_array().unwrap() {
                let name = block["name"].as_str().unwrap();
                for field in block["fields"].as_array().unwrap() {
                    let (field, offset) = (field["name"].as_str().unwrap(), &field["offset"]);
                    asserts +=
                        &format!("static_assert(offsetof(struct {base}_{name}, {field}) == {offset}, \"{name}\");\n");
                }
                asserts += &format!("static_assert(sizeof(struct {base}_{name}) == {}, \"{name}\");\n", block["bytes"]);
            }
            let at_most = plan.capacity();
            for (at, size) in SIZES.into_iter().enumerate() {
                let (width, height, fragments) = size;
                let call = format!("symbols = {base}_symbols({width}, {height}, {fragments});");
                let least = if host_sets_k(plan) { at_most } else { 1 };
                for k in [at_most, least] {
                    calls += &format!("    {call} symbols.k = {k}; {base}_set_defaults(&symbols);\n");
                    calls += &format!("    facts(\"{base}\", &{base}_plan, &symbols);\n");
                    let bytes = resource_bytes(plan, &values(plan, size, k)).unwrap();
                    lines.extend(bytes.iter().map(|(name, bytes)| format!("{base} bytes {name} {bytes}")));
                }
                if at == 1 {
                    calls += &format!("    {call} tables(\"{base}\", &{base}_plan, &symbols);\n");
                    lines.extend(expected(&base, part, &files, plan));
                }
            }
        }
    }
    let program = format!(
        "#include <stdio.h>\n{includes}{asserts}{FACTS}\nint main(void)\n{{\n    struct fragbuf_symbols symbols;\n{calls}    return 0;\n}}\n"
    );
    std::fs::write(folder.join("values.c"), program).unwrap();
    cc(&folder, CPP, &["-fsyntax-only", "values.c"]);
    cc(&folder, C, &["values.c", "-o", "values"]);
    let printed = text(&Command::new(folder.join("values")).output().unwrap().stdout);
    for (number, (printed, expected)) in printed.lines().zip(&lines).enumerate() {
        assert_eq!(printed, expected, "line {number}");
    }
    assert_eq!(printed.lines().count(), lines.len());
    assert!(lines.len() > 3000 && includes.lines().count() > 35, "{} lines", lines.len());
}

/// In module form, the vertex stage and its inputs are the caller's: the header has what the manifest has.
#[test]
fn a_header_of_modules_has_no_vertex_stage() {
    let folder = folder("module");
    let draft = Description::Technique("kplus_array".to_owned());
    let variant = variant(&draft, &[], &Registry::builtin()).unwrap_or_else(|errors| panic!("{errors}"));
    for (form, is_whole) in [(Form::Program, true), (Form::Module, false)] {
        let generation = generated_in(form, &variant, &["glsl"], 0);
        let json: Value = manifest(&generation, 0);
        let header = c_header(&generation, "glass", "kplus_array", 0);
        let blocks = json["uniform_blocks"].as_array().unwrap().iter().filter_map(|block| block["name"].as_str());
        assert_eq!(blocks.clone().any(|name| name == "camera"), is_whole);
        assert_eq!(json["vertex_inputs"].is_array(), is_whole);
        assert_eq!((header.contains("view_projection"), header.contains("GLASS_LOCATION_")), (is_whole, is_whole));
        assert!(blocks.into_iter().all(|name| header.contains(&format!("struct glass_{name} {{"))));
        std::fs::write(folder.join("glass.h"), header).unwrap();
        std::fs::write(folder.join("glass.c"), "#include \"glass.h\"\nint main(void) { return 0; }\n").unwrap();
        cc(&folder, C, &["-Wno-unused", "-fsyntax-only", "glass.c"]);
        cc(&folder, CPP, &["-Wno-unused", "-fsyntax-only", "glass.c"]);
    }
}

/// Every operator of formulas, also where there is no value: each formula is the size of a resource.
#[test]
fn formulas_have_the_values_of_fragbuf() {
    const FORMULAS: [&str; 20] = [
        "n + fragments",
        "n - k",
        "fragments / n",
        "ceil_div(fragments, n)",
        "fragments * kept",
        "min(n, k) + 7 * max(n, k)",
        "n == k",
        "n != k",
        "n < k",
        "n <= k",
        "n > k",
        "n >= k",
        "n && kept",
        "n || kept",
        "pow2(n)",
        "log2_ceil(fragments)",
        "(n - k < 3) * 2",
        "kept / (n - n)",
        "k * (n == 3 && fragments || k < 2)",
        "pixels - width * height + ceil_div(kept, 3)",
    ];
    let folder = folder("formulas");
    let description = Description::Technique("kplus_array".to_owned());
    let variant = variant(&description, &[], &Registry::builtin()).unwrap_or_else(|errors| panic!("{errors}"));
    let mut generation = generated(&variant, &["wgsl"], 0);
    let plan = &mut generation.plans[0].plan;
    let sample = plan.resources[0].clone();
    for (number, formula) in FORMULAS.into_iter().enumerate() {
        let mut planned = sample.clone();
        planned.resource.name = format!("formula_{number}");
        planned.words = plan.symbols.compile(&formula.into()).unwrap();
        plan.resources.push(planned);
    }
    let plan = generation.plans[0].plan.clone();
    std::fs::write(folder.join("f.h"), c_header(&generation, "f", "f", 0)).unwrap();
    let (mut calls, mut expected) = (String::new(), Vec::new());
    let big = 1_u64 << 63;
    for (n, k, fragments, kept) in
        [(0, 1, 0, 0), (3, 3, 7, 9), (5, 3, big, 2), (61, 1, big + 1, 3), (64, 9, 1 << 32, 1 << 30)]
    {
        calls += &format!("    symbols = f_symbols(6, 5, {fragments}u);\n    symbols.n = {n};\n    symbols.k = {k};\n");
        calls += &format!("    symbols.kept = {kept};\n    facts(\"f\", &f_plan, &symbols);\n");
        let values = values(&plan, (6, 5, fragments), k).with(SymbolId::N, n).with(SymbolId::KEPT, kept);
        for planned in &plan.resources {
            let words = values.evaluate(&planned.words, "a formula").ok();
            let bytes = words.and_then(|words| words.checked_mul(4)).unwrap_or(u64::MAX);
            expected.push(format!("f bytes {} {bytes}", planned.resource.name));
        }
    }
    let facts = FACTS.split("static const char *actions").next().unwrap();
    let program = format!(
        "#include <stdio.h>\n#include \"f.h\"\n{facts}\nint main(void)\n{{\n    struct fragbuf_symbols symbols;\n{calls}    return 0;\n}}\n"
    );
    std::fs::write(folder.join("f.c"), program).unwrap();
    cc(&folder, C, &["f.c", "-o", "f"]);
    let printed = text(&Command::new(folder.join("f")).output().unwrap().stdout);
    assert_eq!(printed.lines().collect::<Vec<_>>(), expected);
    assert!(expected.iter().filter(|line| line.ends_with(&u64::MAX.to_string())).count() > 10);
}

/// Names that C, C++ or their headers reserve, names that become equal, and names of files with other characters.
#[test]
fn names_of_descriptions_are_legal_in_c_and_cpp() {
    let folder = folder("names");
    let description = "buffer Restrict_ from kplus_array {
        fragment { color: rgba8, depth: f32, class: u32, Class: u32, double: vec3 }
        uniform { near: f32, far: f32, class: vec3, namespace: u32, template: vec2, a__b: f32, a_0_b: i32, INT32_MAX: f32, padding_12: u32 }
        where |f, u| f.depth < u.far + u.near + u.class.x + u.template.y + u.a__b + u.INT32_MAX && f.class + f.Class != u.namespace + u.padding_12
            && f.double.x < u.a_0_b as f32;
    }";
    let description = Description::Text { file: "names.fragbuf".to_owned(), text: description.to_owned() };
    let variant = variant(&description, &[], &Registry::builtin()).unwrap_or_else(|errors| panic!("{errors}"));
    let generation = generated(&variant, &["wgsl"], 0);
    let stems = ["class", "2 d", "Große__", "kb_"];
    let mut program = String::new();
    for stem in stems {
        let header = c_header(&generation, stem, "a */ \" ??/\n /* \\", 0);
        std::fs::write(folder.join(format!("{}.h", c_name(stem))), header).unwrap();
        program += &format!("#include \"{}.h\"\n", c_name(stem));
    }
    program +=
        "int main(void)\n{\n    struct class_uniforms u;\n    u.near_ = 1.0f;\n    return (int)u.near_ - 1;\n}\n";
    std::fs::write(folder.join("names.c"), program).unwrap();
    cc(&folder, C, &["names.c", "-o", "names"]);
    cc(&folder, CPP, &["-fsyntax-only", "names.c"]);
    assert!(Command::new(folder.join("names")).status().unwrap().success());
}

/// The commands of `examples/c/README.md`.
#[test]
fn the_example_follows_the_frame() {
    let folder = folder("example");
    let description = Path::new(ROOT).join("examples/glass.fragbuf");
    let command = ["generate", description.to_str().unwrap(), "--target", "spirv", "--bindings", "c", "--out", "."];
    let generated = fragbuf(&command, &folder);
    assert!(generated.status.success(), "{}", text(&generated.stderr));
    let source = Path::new(ROOT).join("examples/c/frame.c");
    cc(&folder, C, &[source.to_str().unwrap(), "-o", "frame"]);
    let run = |arguments: &[&str]| Command::new(folder.join("frame")).args(arguments).output().unwrap();
    let printed = text(&run(&["640", "480"]).stdout);
    // 16 slots of one word of 4 bytes; 480 rows of 640 pixels.
    let keys = format!("create buffer keys: {} bytes at set 0, binding 3\n", 16 * 4 * 640 * 480);
    let uploads =
        "upload 16 bytes to binding 0: 640 x 480, k = 16\nupload 16 bytes to binding 1: eye = 0.45 0.37 0.81\n";
    let passes = "store with spirv/store.vert.spv:geometry spirv/store.frag.spv:store: draw the scene\n";
    for expected in [&keys, uploads, passes, "draw 3 vertices\nread word 4 of counters: fragments that timed out\n"] {
        assert!(printed.contains(expected), "{expected}{printed}");
    }
    assert_eq!(run(&["0", "480"]).status.code(), Some(2));
    let large = run(&["4294967295", "4294967295"]);
    assert!(large.status.code() == Some(1) && text(&large.stderr).contains("too large"), "{}", text(&large.stderr));
}

/// A header is a file of the run: a later run without it reports it, and removes it with `--clean`.
#[test]
fn the_manifest_lists_the_header() {
    let folder = folder("manifest");
    let generate = |options: &[&str]| {
        let output = fragbuf(&[&["generate", "kb", "--target", "wgsl", "--out", "p"], options].concat(), &folder);
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stderr)
    };
    assert_eq!(generate(&["--bindings", "c"]), "");
    let json: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("p/manifest.json")).unwrap()).unwrap();
    assert_eq!(json["c_header"], "kb.h");
    let prefixed = generate(&["--bindings", "c", "--prefix", "Left"]);
    assert!(prefixed.contains("1 file of earlier runs, such as p/kb.h"), "{prefixed}");
    assert!(std::fs::read_to_string(folder.join("p/left.h")).unwrap().contains("struct left_frame {"));
    let removed = generate(&["--clean"]);
    assert_eq!(
        (removed.as_str(), folder.join("p/kb.h").exists(), folder.join("p/left.h").exists()),
        ("", false, false)
    );
    let wrong = fragbuf(&["generate", "kb", "--target", "wgsl", "--out", "p", "--bindings", "java"], &folder);
    assert!(
        wrong.status.code() == Some(2) && text(&wrong.stderr).contains("[possible values: c]"),
        "{}",
        text(&wrong.stderr)
    );
}
