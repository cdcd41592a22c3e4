//! What a driver lacks and what a caller may do wrong are errors that name it.

use fragbuf_codegen::Form;
use fragbuf_model::check;
use fragbuf_opengl_host::{Api, Context, Description, Error, Host, Material, Object, Peer, Scene};
use fragbuf_targets::{Generation, Request, TARGETS, generate, manifest};
use fragbuf_templates::Registry;
use serde_json::{Value, json};

use crate::draw::{context, generated, host, read};
use crate::hosts::technique::{IDENTITY, variant};
use crate::material::material;

const SIZE: [u32; 2] = [4, 4];

fn generation(api: Api, form: Form, technique: &str) -> Generation {
    let variant = variant(technique, &[]).unwrap();
    generated(api, form, &variant, &Registry::builtin()).unwrap_or_else(|why| panic!("{why}"))
}

/// Opens a host with a changed manifest; returns the error.
fn error(context: &Context, generation: &Generation, change: &dyn Fn(&mut Value)) -> String {
    let mut manifest = manifest(generation, 0);
    change(&mut manifest);
    let read = |path: &str| read(generation, path);
    Host::new(context, &manifest.to_string(), &read, SIZE).err().unwrap().0
}

#[test]
fn missing_extensions_and_limits_are_named() {
    for api in [Api::OpenGl, Api::OpenGlEs] {
        let (context, generation) = (context(api), generation(api, Form::Program, "ab_ll"));
        let missing = error(&context, &generation, &|manifest| {
            manifest["requires"][api.target()]["extensions"] = json!(["GL_NO_one", "GL_NO_other"]);
        });
        assert_eq!(missing, "the driver lacks GL_NO_one and GL_NO_other");
        let needed = |name: &'static str, needed: Value| {
            error(&context, &generation, &move |manifest| {
                manifest["limits"] = json!([{ "opengl": name, "webgpu": null, "needed": needed }]);
            })
        };
        let unmet = needed("GL_MAX_DRAW_BUFFERS", json!(1000));
        assert!(unmet.contains("GL_MAX_DRAW_BUFFERS is ") && unmet.contains("the passes need 1000"), "{unmet}");
        let unmet = needed("GL_MAX_TEXTURE_SIZE", json!("width * pow2(30)"));
        assert!(unmet.contains("the passes need 4294967296"), "{unmet}");
        assert_eq!(needed("GL_MAX_NOTHING", json!(1)), "unknown limit `GL_MAX_NOTHING`");
    }
}

/// The manifest says why a target has no files, and so does the host.
#[test]
fn a_technique_that_the_target_rejects_is_an_error_with_the_reason() {
    let variant = variant("kb_sr", &[("k", "4")]).unwrap();
    let targets: Vec<_> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &Registry::builtin()).unwrap();
    let error = error(&context(Api::OpenGlEs), &generation, &|_| {});
    let reason = "`storage: stencil_routed` requires a fixed sample mask and several samples per pixel";
    assert_eq!(error, format!("the target `glsl-es` does not have these passes: {reason}"));
}

#[test]
fn mistakes_of_a_material_have_its_line() {
    for api in [Api::OpenGl, Api::OpenGlEs] {
        let (context, generation) = (context(api), generation(api, Form::Module, "ab_sb"));
        let good = material(&generation.plans[0].plan.variant, "glass");
        let open = |material: &Material| {
            let read = |path: &str| read(&generation, path);
            Host::with_material(&context, &manifest(&generation, 0).to_string(), &read, SIZE, material)
        };
        assert!(open(&good).is_ok());
        let fragment = format!("\n\nvoid wrong() {{ no_such_name = 1.0; }}\n{}", good.fragment);
        let error = open(&Material { fragment, ..good.clone() }).err().unwrap().0;
        assert!(error.starts_with("the material's fragment shader with glsl"), "{error}");
        assert!(error.contains(":3(") && error.contains("no_such_name"), "{error}");
        let vertex = format!("\nfloat wrong = no_such_name;\n{}", good.vertex);
        let error = open(&Material { vertex, ..good }).err().unwrap().0;
        assert!(error.starts_with("the material's vertex shader: ") && error.contains(":2("), "{error}");
    }
}

#[test]
fn a_form_needs_its_way_of_drawing() {
    let context = context(Api::OpenGl);
    let module = generation(Api::OpenGl, Form::Module, "ab_ll");
    assert_eq!(error(&context, &module, &|_| {}), "the passes are in module form: they need a material");
    let program = generation(Api::OpenGl, Form::Program, "ab_ll");
    let material = material(&program.plans[0].plan.variant, "");
    let read = |path: &str| read(&program, path);
    let opened = Host::with_material(&context, &manifest(&program, 0).to_string(), &read, SIZE, &material);
    assert_eq!(opened.err().unwrap().0, "the passes are in program form: a material needs `--form module`");
}

#[test]
fn mistakes_of_a_caller_are_errors() {
    let context = context(Api::OpenGlEs);
    let variant = variant("ab_ll", &[("opaque", "in_shader")]).unwrap();
    let generation = generated(Api::OpenGlEs, Form::Program, &variant, &Registry::builtin());
    let mut host = host(&context, &generation.unwrap_or_else(|why| panic!("{why}")), SIZE).unwrap();
    let objects = [Object { first: 0, count: 3, bounds: [[-1.0; 3], [1.0; 3]] }];
    let scene = |vertices| Scene { vertices, objects: &objects, view_projection: IDENTITY };
    let too_few = host.render(&scene(&[0; 28 * 2]), [0.0; 4]).err().unwrap().0;
    assert_eq!(too_few, "an object has 3 vertices from 0 on, and the scene has 2");
    let missing = host.render(&scene(&[0; 28 * 3]), [0.0; 4]).err().unwrap().0;
    assert_eq!(missing, "`opaque` is a texture of the engine: set its texels before the first frame");
    assert_eq!(
        host.set_texture("opaque", &[1.0]).err().unwrap().0,
        "1 texels for `opaque`, and the frame has 16 pixels"
    );
    assert_eq!(host.set_texture("heads", &[1.0]).err().unwrap().0, "no external texture `heads`");
    host.set_texture("opaque", &[1.0; 16]).unwrap();
    let unset = host.render(&scene(&[0; 28 * 3]), [0.0; 4]).err().unwrap().0;
    assert!(unset.contains("a symbol of its size has no value: set it before the frame"), "{unset}");
    assert!(host.set_symbol("no_such_symbol", 1).is_err() && host.set_uniform("no_such_uniform", &[0; 4]).is_err());
    host.set_symbol("fragments", 1 << 28).unwrap();
    let large = host.render(&scene(&[0; 28 * 3]), [0.0; 4]).err().unwrap().0;
    assert!(large.contains("bytes, and GL_MAX_SHADER_STORAGE_BLOCK_SIZE is "), "{large}");
    host.set_symbol("fragments", 16).unwrap();
    assert_eq!(host.render(&scene(&[0; 28 * 3]), [0.0; 4]).unwrap().lost, 0);
}

/// A manifest may be damaged, or written by anybody: its numbers are not allocated, and nothing overflows.
#[test]
fn damaged_manifests_are_errors() {
    let (context, generation) = (context(Api::OpenGl), generation(Api::OpenGl, Form::Program, "ab_ll"));
    let large = error(&context, &generation, &|manifest| manifest["uniform_blocks"][0]["bytes"] = json!(1_u64 << 40));
    assert!(large.contains("1099511627776 bytes, more than 65536"), "{large}");
    for offset in [64, u64::MAX] {
        let outside = error(&context, &generation, &|manifest| {
            manifest["uniform_blocks"][0]["fields"][0]["offset"] = json!(offset);
        });
        assert!(outside.contains("is outside of the uniform block"), "{outside}");
    }
    let indirect = error(&context, &generation, &|manifest| {
        let steps = manifest["steps"].as_array_mut().unwrap();
        let pass = steps.iter_mut().find(|step| step["do"] == "pass").unwrap();
        pass["uses"]["counters"] = json!("indirect");
    });
    assert!(
        indirect.contains("has arguments in a buffer (`indirect`), which this host does not support"),
        "{indirect}"
    );
}

/// 2^32 workgroups are not 0.
#[test]
fn workgroups_beyond_the_driver_are_errors() {
    let (context, generation) = (context(Api::OpenGl), generation(Api::OpenGl, Form::Program, "ab_sb"));
    let mut manifest = manifest(&generation, 0);
    let steps = manifest["steps"].as_array_mut().unwrap();
    steps.iter_mut().find(|step| step["kind"] == "compute").unwrap()["groups"][0] = json!("pow2(32)");
    let mut host = Host::new(&context, &manifest.to_string(), &|path| read(&generation, path), SIZE).unwrap();
    let scene = Scene { vertices: &[], objects: &[], view_projection: IDENTITY };
    let error = host.render(&scene, [0.0; 4]).err().unwrap().0;
    assert!(error.contains(" has 4294967296 workgroups, and the device allows "), "{error}");
}

/// A uniform without a value would be 0, and the image another one.
#[test]
fn uniforms_have_values_of_their_type() {
    let text = "buffer Cut from ab_ll { uniform { cut: f32, tint: vec4 } where |f, u| f.depth > u.cut + u.tint.x; }";
    let variant = fragbuf_syntax::parse(text, "test").draft.map(|draft| check(&draft, &Registry::builtin()));
    let variant = variant.unwrap().unwrap_or_else(|errors| panic!("{errors}"));
    let context = context(Api::OpenGl);
    let generation = generated(Api::OpenGl, Form::Program, &variant, &Registry::builtin());
    let mut host = host(&context, &generation.unwrap_or_else(|why| panic!("{why}")), SIZE).unwrap();
    let scene = Scene { vertices: &[], objects: &[], view_projection: IDENTITY };
    host.set_symbol("fragments", 16).unwrap();
    let unset = |host: &mut Host<'_>| host.render(&scene, [0.0; 4]).err().map(|error| error.0);
    assert_eq!(unset(&mut host).unwrap(), "the uniform `cut` has no value: set it with `set_uniform`");
    assert_eq!(
        host.set_uniform("tint", &[0; 4]).unwrap_err().0,
        "the uniform `tint` is a `vec4<f32>`: set 16 bytes, not 4"
    );
    assert_eq!(
        host.set_uniform("cat", &[0; 4]).unwrap_err().0,
        "the description has no uniform `cat`: it has `cut`, `tint`"
    );
    host.set_uniform("cut", &[0; 4]).unwrap();
    host.set_uniform("tint", &[0; 16]).unwrap();
    assert_eq!(unset(&mut host), None);
}

#[test]
fn shaders_of_other_projects_need_opengl() {
    let context = context(Api::OpenGlEs);
    let description =
        Description::parse(r#"{"technique": "ab_ll", "note": "", "include": "", "memory": [], "passes": []}"#);
    let no_file = |_: &str| Err(Error(String::new()));
    let error = Peer::new(&context, &description.unwrap(), &no_file, SIZE).err().unwrap();
    assert_eq!(error.0, "shaders of other projects need OpenGL, and the context is one of OpenGL ES");
}
