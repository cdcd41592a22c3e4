//! Tests two instances of one template in a program, and two buffers in a shader.

use fragbuf::vocabulary::{Access, Blend, KeepDefault, Pass, Row, Step, Technique, Template};
use fragbuf::{Form, Generation, Registry, Request, TARGETS, Target, check, generate};
use fragbuf_model::{Draft, SourceSpan};

use crate::validators;

/// Stores even fragments in one list and odd ones in another.
const STORE_TWO: &str = "
@fragment
fn store_two(inputs: FragmentInput) {
    let entry = fragment_pack(fragment_from_inputs(inputs));
    let pixel = pixel_index(inputs.position.xy);
    if (entry.key & 1u) == 0u {
        front_insert(pixel, entry);
    } else {
        back_insert(pixel, entry);
    }
}
";

const RESOLVE_TWO: &str = "
@fragment
fn resolve_two(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = pixel_index(position.xy);
    for (var cursor = front_first(pixel); cursor != END; cursor = front_next(pixel, cursor)) {
        sort_gather(front_read(pixel, cursor));
    }
    for (var cursor = back_first(pixel); cursor != END; cursor = back_next(pixel, cursor)) {
        sort_gather(back_read(pixel, cursor));
    }
    sort_finish();
    return resolve_layers();
}
";

fn two_lists() -> Registry {
    let skeleton = |key: &str, text: &'static str, calls| Row {
        template: Some(Template::new("test.wgsl", text)),
        calls,
        ..Row::new("pass", key, "", "")
    };
    let both =
        |pass: Pass| pass.implementation("front", "linked_list", "front").implementation("back", "linked_list", "back");
    let registry = Registry::builtin();
    let list = registry.row("storage", "linked_list").unwrap().clone();
    let storage = Row {
        steps: vec![
            Step::Pass(Pass { name: "store".to_owned(), ..both(Pass::geometry("store", "store_two")) }),
            Step::Pass(both(Pass::fullscreen("resolve", "resolve_two")).target("output", Blend::Over)),
        ],
        resources: vec![],
        key: "two_lists".to_owned(),
        ..list
    };
    assert!(storage.uses.iter().all(|usage| usage.access != Access::Attachment));
    registry
        .with(skeleton("store_two", STORE_TWO, vec!["addressing", "counters"]))
        .with(skeleton("resolve_two", RESOLVE_TWO, vec!["addressing", "sort", "resolve", "counters"]))
        .with(storage)
        .with_technique(Technique {
            key: "two_lists".to_owned(),
            title: "",
            paper: "",
            summary: "",
            keep: KeepDefault::All,
            choices: vec![("storage", "two_lists")],
        })
}

fn generation(registry: &Registry, key: &str, form: Form, prefix: &str, group: u32) -> Generation {
    let draft = Draft::from_technique(key, &SourceSpan::new(key, 1, 1));
    let variant = check(&draft, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form, prefix, group };
    generate(&variant, &request, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

#[test]
fn a_program_has_two_lists() {
    let generation = generation(&two_lists(), "two_lists", Form::Program, "", 0);
    let plan = &generation.plans[0].plan;
    // Two heads per pixel, and two pools that each fit every fragment.
    assert_eq!(plan.words_per_pixel, "6f+2");
    for name in ["front_heads", "front_nodes", "back_heads", "back_links", "back_pool"] {
        assert!(plan.resource(name).is_some(), "{name}");
    }
    assert!(validators::validate(generation.files.iter()) > 0);
}

#[test]
fn two_buffers_share_a_shader() {
    let registry = Registry::builtin();
    let near = generation(&registry, "kplus_array", Form::Module, "near", 1);
    let all = generation(&registry, "ab_ll", Form::Module, "all", 2);
    for target in ["wgsl", "wgsl-native"] {
        let text = |generation: &Generation| {
            let file = generation.files.iter().find(|file| file.target == target && file.pass == "store").unwrap();
            assert!(file.entry_points.iter().all(|(stage, _)| *stage == "module"));
            String::from_utf8(file.bytes.clone()).unwrap()
        };
        let host = "
            @fragment
            fn shade(@builtin(position) position: vec4<f32>) {
                near_store_fragment(position.xy, near_Fragment(vec4<f32>(1.0), position.z));
                all_store_fragment(position.xy, all_Fragment(vec4<f32>(1.0), position.z));
            }";
        let shader = format!("{}{}{host}", text(&near), text(&all));
        let module = naga::front::wgsl::parse_str(&shader).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&shader)));
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::MEMORY_DECORATION_COHERENT,
        );
        validator.validate(&module).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&shader)));
    }
}

#[test]
fn glsl_modules_are_called_from_the_callers_shader() {
    let registry = Registry::builtin();
    let near = generation(&registry, "kplus_array", Form::Module, "near", 1);
    let all = generation(&registry, "ab_ll", Form::Module, "all", 2);
    for (target, version) in
        [("glsl", "#version 450"), ("glsl-vulkan", "#version 450\n#extension GL_KHR_memory_scope_semantics : require")]
    {
        let text = |generation: &Generation| {
            let file = generation.files.iter().find(|file| file.target == target && file.pass == "store").unwrap();
            String::from_utf8(file.bytes.clone()).unwrap()
        };
        let shader = format!(
            "{version}\n{}{}\nvoid main() {{\n    \
             near_store_fragment(gl_FragCoord.xy, near_Fragment(vec4(1.0), gl_FragCoord.z));\n    \
             all_store_fragment(gl_FragCoord.xy, all_Fragment(vec4(1.0), gl_FragCoord.z));\n}}\n",
            text(&near),
            text(&all)
        );
        let file = fragbuf::File {
            path: format!("{target}/host.frag.glsl"),
            target,
            pass: "store".to_owned(),
            entry_points: vec![("fragment", "main".to_owned())],
            bytes: shader.into_bytes(),
        };
        assert_eq!(validators::validate(std::iter::once(&file)), 1);
    }
}

#[test]
fn targets_without_linkable_functions_reject_modules() {
    let generation = generation(&Registry::builtin(), "kplus_array", Form::Module, "", 0);
    let rejected: Vec<&str> = generation.unsupported.iter().map(|(target, _)| target.name).collect();
    assert_eq!(rejected, ["spirv", "msl"]);
    for (_, missing) in &generation.unsupported {
        assert!(missing.to_string().contains("functions that the caller's shader can call"), "{missing}");
    }
}
