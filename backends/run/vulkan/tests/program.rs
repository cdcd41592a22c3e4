//! The program of the host, with files as `fragbuf generate` writes them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf_templates::Registry;

use crate::hosts::panes::assert_panes;
use crate::hosts::technique::variant;
use crate::stage::Generated;

const SIZE: [u32; 2] = [480, 320];

/// Writes the files of a technique into an empty folder.
fn folder(name: &str, key: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let generated = Generated::of(&variant(key, &[]).unwrap(), &Registry::builtin());
    let manifest = ("manifest.json".to_owned(), generated.manifest.into_bytes());
    for (path, bytes) in generated.files.into_iter().chain([manifest]) {
        let file = folder.join(path);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(file, bytes).unwrap();
    }
    folder
}

fn run(arguments: &[&str], folder: &Path) -> (Output, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf-vulkan-host"));
    let output = command.args(arguments).current_dir(folder).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    (output, errors)
}

/// Compares an image with the panes. It is opaque, as white behind them is.
fn assert_expected(path: &Path) {
    let file = std::fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(([info.width, info.height], info.color_type), (SIZE, png::ColorType::Rgba));
    assert!(bytes.chunks_exact(4).all(|pixel| pixel[3] == 255), "{}", path.display());
    let pixels: Vec<[u8; 3]> = bytes.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    assert_panes(&path.display().to_string(), (SIZE, &pixels), false);
}

/// The command of the guide draws the panes, and the guide shows them. `INSTA_UPDATE=always` replaces its image by what is drawn.
#[test]
fn the_guide_shows_what_the_program_draws() {
    let work = folder("program", "ab_sb");
    let moved = work.join("passes");
    std::fs::create_dir_all(&moved).unwrap();
    for entry in std::fs::read_dir(&work).unwrap().map(|entry| entry.unwrap()).filter(|entry| entry.path() != moved) {
        std::fs::rename(entry.path(), moved.join(entry.file_name())).unwrap();
    }
    let (output, errors) = run(&["passes", "panes.png", "--validate", "--device", "llvmpipe"], &work);
    assert!(output.status.success() && errors.is_empty(), "{errors}");
    assert_expected(&work.join("panes.png"));
    let shown = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/vulkan/panes.png");
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::create_dir_all(shown.parent().unwrap()).unwrap();
        std::fs::copy(work.join("panes.png"), &shown).unwrap();
    }
    assert_expected(&shown);
}

#[test]
fn mistakes_are_errors_on_stderr() {
    let work = folder("mistakes", "kb_ps");
    let (output, errors) = run(&["."], &work);
    assert!(output.status.code() == Some(2) && errors.starts_with("usage:"), "{errors}");
    let (output, errors) = run(&["nowhere", "out.png"], &work);
    assert!(output.status.code() == Some(1) && errors.contains("nowhere/manifest.json"), "{errors}");
    let (output, errors) = run(&[".", "out.png", "--device", "llvmpipe"], &work);
    assert!(output.status.code() == Some(1) && errors.contains("VK_EXT_fragment_shader_interlock"), "{errors}");
    let (output, errors) = run(&[".", "out.png", "--device"], &work);
    assert!(output.status.code() == Some(2) && errors.starts_with("usage:"), "{errors}");
}
