//! The JSON Schema: it accepts every manifest, refuses every broken one, and the guide explains its words.

use std::collections::BTreeSet;

use boon::{Compiler, Draft, SchemaIndex, Schemas};
use fragbuf::{JSON_SCHEMA, SCHEMA};
use serde_json::{Value, json};

use super::{ALL, Written};

struct Judge {
    schemas: Schemas,
    index: SchemaIndex,
}

impl Judge {
    fn new() -> Self {
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        compiler.set_default_draft(Draft::V2020_12);
        compiler.add_resource("manifest.schema.json", parsed()).unwrap();
        let index = compiler.compile("manifest.schema.json", &mut schemas).unwrap();
        Judge { schemas, index }
    }

    fn accepts(&self, manifest: &Value) -> bool {
        self.schemas.validate(manifest, self.index).is_ok()
    }
}

fn parsed() -> Value {
    serde_json::from_str(JSON_SCHEMA).unwrap()
}

fn case(name: &str) -> &'static Written {
    ALL.iter().find(|written| written.name == name).unwrap_or_else(|| panic!("no case `{name}`"))
}

#[test]
fn every_manifest_is_accepted() {
    let judge = Judge::new();
    for written in ALL.iter() {
        if let Err(error) = judge.schemas.validate(&written.manifest, judge.index) {
            panic!("{}: {error:#}", written.name);
        }
    }
    let modules = ALL.iter().filter(|written| written.manifest["form"] == "module").count();
    assert!(ALL.len() > 100 && modules > 40, "{} manifests, {modules} of modules", ALL.len());
    assert_eq!(parsed()["title"], SCHEMA);
}

/// Members that a manifest may leave out.
const OPTIONAL: [&str; 15] = [
    "until",
    "texel",
    "text_constants",
    "per_iteration",
    "objects",
    "default",
    "value",
    "depth",
    "stencil",
    "samples",
    "may_lag",
    "exchanged",
    "bindings_of",
    "earlier_files",
    "column_stride",
];

/// Objects whose members have names of their own.
const MAPS: [&str; 8] =
    ["axes", "constants", "text_constants", "tier", "unsupported", "uses", "bindings_of", "requires"];

/// Every member that is not optional is required, and every value has a type: nothing is accepted without the one or with an empty object
/// in place of the other.
#[test]
fn a_manifest_with_a_missing_member_or_a_value_of_another_type_is_refused() {
    let judge = Judge::new();
    for name in ["kb_sr, Program", "ab_sb, Program", "kb_multi, Module", "predicted, Program", "custom, Program"] {
        let mut manifest = case(name).manifest.clone();
        shorten(&mut manifest);
        assert!(judge.accepts(&manifest), "{name}");
        let (mut removed, mut replaced) = (0, 0);
        for pointer in pointers(&manifest) {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let in_map = MAPS.iter().any(|map| parent.ends_with(&format!("/{map}")));
            let is_member = manifest.pointer(parent).unwrap().is_object() && !in_map && !OPTIONAL.contains(&key);
            if is_member {
                let mut broken = manifest.clone();
                broken.pointer_mut(parent).unwrap().as_object_mut().unwrap().remove(key);
                assert!(!judge.accepts(&broken), "{name} without {pointer}");
                removed += 1;
            }
            let mut broken = manifest.clone();
            let place = broken.pointer_mut(&pointer).unwrap();
            *place = if place.is_object() { json!(-1) } else { json!({ "no": "such" }) };
            assert!(!judge.accepts(&broken), "{name} with another {pointer}");
            replaced += 1;
        }
        assert!(removed > 200 && replaced > 300, "{name}: {removed} members, {replaced} values");
    }
}

/// Keeps the first elements of long lists of equal shape.
fn shorten(manifest: &mut Value) {
    for list in ["files", "symbols", "counters", "limits"] {
        manifest[list].as_array_mut().unwrap().truncate(4);
    }
}

/// Returns the JSON pointers of all values but the root.
fn pointers(value: &Value) -> Vec<String> {
    let children: Vec<(String, &Value)> = match value {
        Value::Object(map) => {
            map.iter().map(|(key, value)| (key.replace('~', "~0").replace('/', "~1"), value)).collect()
        }
        Value::Array(list) => list.iter().enumerate().map(|(index, value)| (index.to_string(), value)).collect(),
        _ => Vec::new(),
    };
    let below = children.into_iter().flat_map(|(key, value)| {
        let own = format!("/{key}");
        let below: Vec<String> = pointers(value).iter().map(|pointer| format!("{own}{pointer}")).collect();
        std::iter::once(own).chain(below)
    });
    below.collect()
}

/// Words that do not exist, and members that belong elsewhere.
#[test]
fn a_manifest_with_an_unknown_word_is_refused() {
    let judge = Judge::new();
    let routed = &case("kb_sr, Program").manifest;
    let position = |manifest: &Value, pass: &str| {
        let steps = manifest["steps"].as_array().unwrap();
        steps.iter().position(|step| step["pass"] == pass).unwrap()
    };
    let (route, store, resolve) = (position(routed, "route"), position(routed, "store"), position(routed, "resolve"));
    let textures = routed["steps"][resolve]["bindings"].as_array().unwrap();
    let texture = textures.iter().position(|binding| binding["type"] == "texture").unwrap();
    let at = |step: usize, rest: &str| format!("/steps/{step}/{rest}");
    let sampled = |rest: &str| at(resolve, &format!("bindings/{texture}/{rest}"));
    let broken = [
        ("/schema".to_owned(), json!("fragbuf-manifest/3")),
        ("/form".to_owned(), json!("library")),
        ("/conventions/matrices".to_owned(), json!("row-major")),
        ("/conventions/clip_depth".to_owned(), json!([-1, 1])),
        ("/files/0/target".to_owned(), json!("glsl-webgl")),
        ("/files/0/stage".to_owned(), json!("geometry")),
        ("/symbols/0/when".to_owned(), json!("never")),
        ("/symbols/0/set_by".to_owned(), json!("engine")),
        ("/features/0".to_owned(), json!("atomics")),
        ("/resources/0/init".to_owned(), json!("host")),
        ("/resources/0/words".to_owned(), json!("k ** pixels & 1")),
        ("/resources/0/least_bytes".to_owned(), json!(0)),
        ("/resources/1/texture/format".to_owned(), json!("rgba32float")),
        ("/resources/1/texture/described".to_owned(), json!("lut")),
        ("/resources/1/texture/view_dimension".to_owned(), json!("2d")),
        ("/whole_frame".to_owned(), json!(false)),
        ("/requires/glsl/api".to_owned(), json!("webgl")),
        ("/requires/glsl/version".to_owned(), json!("four")),
        ("/requires/metal".to_owned(), routed["requires"]["glsl"].clone()),
        (at(0, "do"), json!("draw")),
        (at(route, "kind"), json!("compute")),
        (at(route, "uses/routing"), json!("write")),
        (at(route, "state/stencil/compare"), json!("lequal")),
        (at(route, "state/stencil/pass"), json!("increment")),
        (at(route, "state/samples/coverage"), json!("centroid")),
        (at(route, "per_iteration/0"), json!("uses")),
        (at(store, "vertices"), json!(3)),
        (at(store, "state/targets/0/blend"), json!("replace")),
        (at(resolve, "state/targets/0/blend/destination"), json!("one-minus-source-alpha")),
        (at(resolve, "state/targets/0/blend/operation"), json!("subtract")),
        (at(resolve, "bindings/0/type"), json!("read-write-storage")),
        (at(resolve, "bindings/0/type"), json!("texture")),
        (at(resolve, "bindings/0/stages/0"), json!("geometry")),
        (at(resolve, "bindings/0/multisampled"), json!(false)),
        (sampled("type"), json!("storage")),
        (sampled("sample_type"), json!("float")),
        (sampled("aspect"), json!("stencil")),
        (sampled("view_dimension"), json!("2d-array")),
    ];
    for (pointer, value) in broken {
        let mut manifest = routed.clone();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let parent = manifest.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer}"));
        match key.parse::<usize>() {
            Ok(index) => parent[index] = value.clone(),
            Err(_) => parent[key] = value.clone(),
        }
        assert!(!judge.accepts(&manifest), "{pointer}: {value}");
    }
    let looped = &case("kb_multi, Program").manifest;
    let mut manifest = looped.clone();
    let end = looped["steps"].as_array().unwrap().iter().position(|step| step["do"] == "loop_end").unwrap();
    manifest["steps"][end]["until"] = json!({ "zero": "changed" });
    assert!(!judge.accepts(&manifest));
}

/// What belongs to programs is no part of a module, and the reverse.
#[test]
fn the_forms_are_apart() {
    let judge = Judge::new();
    let (program, module) = (&case("kb_multi, Program").manifest, &case("kb_multi, Module").manifest);
    assert!(module.get("vertex_inputs").is_none());
    let text = module.to_string();
    for word in ["view_projection", "\"camera\"", "maxVertexAttributes", "maxInterStageShaderVariables"] {
        assert!(program.to_string().contains(word) && !text.contains(word), "{word}");
    }
    for (manifest, form) in [(program, "module"), (module, "program")] {
        let mut swapped = manifest.clone();
        swapped["form"] = form.into();
        assert!(!judge.accepts(&swapped), "{form}");
    }
    let mut with_camera = module.clone();
    with_camera["uniform_blocks"].as_array_mut().unwrap().push(program["uniform_blocks"][1].clone());
    assert!(!judge.accepts(&with_camera));
}

/// The schema lists every member that a manifest has, and the guide names every member and every word of the schema.
#[test]
fn the_schema_and_the_guide_are_complete() {
    let guide = include_str!("../../src/guide/manifest.md");
    let (mut members, mut words) = (BTreeSet::new(), BTreeSet::new());
    collect(&parsed(), &mut members, &mut words);
    for written in ALL.iter() {
        for pointer in pointers(&written.manifest) {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let in_map = MAPS.iter().any(|map| parent.ends_with(&format!("/{map}")));
            let is_listed = in_map || members.contains(key) || written.manifest.pointer(parent).unwrap().is_array();
            assert!(is_listed, "{}: {pointer}", written.name);
        }
    }
    let quoted: BTreeSet<&str> = guide.split('`').skip(1).step_by(2).collect();
    let is_explained = |word: &String| {
        let is_part = |quote: &str| quote.split(|letter: char| " :{}\"[],()".contains(letter)).any(|part| part == word);
        quoted.iter().any(|quote| is_part(quote))
    };
    let missing: Vec<&String> = members.iter().chain(&words).filter(|word| !is_explained(word)).collect();
    assert!(missing.is_empty(), "the guide does not explain {missing:?}");
}

/// Collects the names of members, and the words of enumerations.
fn collect(schema: &Value, members: &mut BTreeSet<String>, words: &mut BTreeSet<String>) {
    match schema {
        Value::Object(map) => {
            if let Some(Value::Object(properties)) = map.get("properties") {
                members.extend(properties.keys().cloned());
            }
            let one = map.get("const").into_iter();
            let several = map.get("enum").and_then(Value::as_array).into_iter().flatten();
            words.extend(one.chain(several).filter_map(|word| word.as_str().map(str::to_owned)));
            map.values().for_each(|value| collect(value, members, words));
        }
        Value::Array(list) => list.iter().for_each(|value| collect(value, members, words)),
        _ => {}
    }
}
