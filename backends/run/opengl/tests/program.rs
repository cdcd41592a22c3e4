//! The program draws what the guide's chapter shows, on both APIs and in both forms.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf_codegen::Form;
use fragbuf_opengl_host::Api;
use fragbuf_targets::{Request, generate, manifest, target};
use fragbuf_templates::Registry;

use crate::hosts::panes::assert_panes;
use crate::hosts::technique::variant;

const SIZE: [u32; 2] = [480, 360];

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/opengl")
}

/// Writes the files of a generation as the command line does.
fn generated(folder: &str, technique: &str, set: &[(&str, &str)], api: Api, form: Form) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let variant = variant(technique, set).unwrap();
    let request = Request { targets: &[target(api.target()).unwrap()], form, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &Registry::builtin()).unwrap();
    let write = |path: &str, bytes: &[u8]| {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    };
    generation.files.iter().for_each(|file| write(&file.path, &file.bytes));
    write("manifest.json", manifest(&generation, 0).to_string().as_bytes());
    folder
}

fn run(arguments: &[&Path]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf-opengl-host")).args(arguments).output().unwrap()
}

fn pixels(path: &Path) -> Vec<[u8; 3]> {
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(([info.width, info.height], info.color_type), (SIZE, png::ColorType::Rgb));
    bytes.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
}

fn assert_expected(path: &Path, has_rings: bool) {
    assert_panes(&path.display().to_string(), (SIZE, &pixels(path)), has_rings);
}

#[test]
fn the_program_draws_panes_and_the_guide_shows_them() {
    let shaders = ["pane.vert.glsl", "pane.frag.glsl"].map(|name| examples().join(name));
    for (api, form) in
        [Api::OpenGl, Api::OpenGlEs].into_iter().flat_map(|api| [Form::Program, Form::Module].map(|form| (api, form)))
    {
        let name = format!("panes-{}-{form:?}", api.target());
        let folder = generated(&name, "kplus_array", &[("k", "6")], api, form);
        let out = folder.join("panes.png");
        let mut arguments: Vec<&Path> = Vec::new();
        arguments.extend((api == Api::OpenGlEs).then_some(Path::new("--es")));
        if form == Form::Module {
            arguments.extend([Path::new("--material"), &shaders[0], &shaders[1]]);
        }
        arguments.extend([folder.as_path(), &out]);
        let output = run(&arguments);
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        assert_expected(&out, form == Form::Module);
    }
    assert_expected(&examples().join("panes.png"), false);
    assert_expected(&examples().join("rings.png"), true);
}

#[test]
fn the_program_reports_mistakes() {
    let folder = generated("mistakes", "ab_ll", &[], Api::OpenGl, Form::Program);
    let out = folder.join("out.png");
    let error = |arguments: &[&Path]| {
        let output = run(arguments);
        (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, message) = error(&[&folder]);
    assert!(code == 2 && message.starts_with("usage: fragbuf-opengl-host "), "{message}");
    let (code, message) = error(&[Path::new("--es"), &folder, &out]);
    assert_eq!(
        (code, message.as_str()),
        (1, "error: the manifest has no files of the target `glsl-es`: generate them with `--target glsl-es`\n")
    );
    let nowhere = folder.join("nowhere");
    let (code, message) = error(&[&nowhere, &out]);
    assert!(code == 1 && message.contains("nowhere/manifest.json: "), "{message}");
}
