//! Tests `--watch`: a child process writes its output again after each change of a file, and prints errors without ending.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use crate::render::{fragbuf, read, stderr};

/// After this time a child that shows nothing is taken for hung. No test measures time.
const DEADLINE: Duration = Duration::from_secs(240);

/// A child process that watches, and the lines of its stderr.
struct Watching {
    child: Child,
    lines: Receiver<String>,
}

impl Watching {
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_fragbuf"))
            .args(arguments)
            .arg("--watch")
            .current_dir(folder)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, lines) = channel();
        let stderr = BufReader::new(child.stderr.take().unwrap());
        std::thread::spawn(move || stderr.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        Watching { child, lines }
    }

    /// Waits for the end of a run and returns what it printed.
    fn run(&mut self) -> String {
        let (mut text, start) = (String::new(), Instant::now());
        while start.elapsed() < DEADLINE {
            match self.lines.recv_timeout(Duration::from_millis(100)) {
                Ok(line) => {
                    text += &format!("{line}\n");
                    if line.contains("; watching ") {
                        return text;
                    }
                }
                Err(_) => assert!(self.child.try_wait().unwrap().is_none(), "the process ended: {text}"),
            }
        }
        panic!("no run ended: {text}");
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn folder(name: &str) -> PathBuf {
    crate::render::folder(&format!("watch-{name}"))
}

#[test]
fn generation_follows_the_description_and_its_user_files() {
    let folder = folder("generate");
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/user_storage");
    for name in ["first_k.fragbuf", "first_k.wgsl"] {
        std::fs::copy(examples.join(name), folder.join(name)).unwrap();
    }
    let (description, storage) = (folder.join("first_k.fragbuf"), folder.join("first_k.wgsl"));
    let store = || std::fs::read_to_string(folder.join("out/wgsl/store.wgsl")).unwrap();
    let edit = |path: &Path, from: &str, to: &str| {
        let text = std::fs::read_to_string(path).unwrap();
        assert!(text.contains(from), "{} has no {from}", path.display());
        std::fs::write(path, text.replacen(from, to, 1)).unwrap();
    };
    let mut watching = Watching::start(&folder, &["generate", "first_k.fragbuf", "--target", "wgsl", "--out", "out"]);
    assert_eq!(watching.run(), "note: done; watching 2 files\n");
    assert!(!store().contains("A comment of the test"));
    edit(&storage, "// The first k fragments", "// A comment of the test\n// The first k fragments");
    assert_eq!(watching.run(), "note: done; watching 2 files\n");
    assert!(store().contains("A comment of the test"));
    // An error is printed, and the next change runs again.
    edit(&description, "buffer ", "bufer ");
    let failed = watching.run();
    assert!(failed.contains("first_k.fragbuf:") && failed.contains("error["), "{failed}");
    assert!(failed.ends_with("note: failed; watching 2 files\n"), "{failed}");
    edit(&description, "bufer ", "buffer ");
    assert_eq!(watching.run(), "note: done; watching 2 files\n");
}

#[test]
fn an_image_follows_the_model_and_its_materials() {
    let folder = folder("render");
    let material = |color: &str| std::fs::write(folder.join("m.mtl"), format!("newmtl a\nKd {color}\n")).unwrap();
    let model = |z: f64| {
        let text = format!("mtllib m.mtl\nv -1 -1 {z}\nv 1 -1 {z}\nv 1 1 {z}\nv -1 1 {z}\nusemtl a\nf 1 2 3 4\n");
        std::fs::write(folder.join("m.obj"), text).unwrap();
    };
    material("1 0 0");
    model(0.5);
    let view = ["--scene", "m.obj", "--camera", "clip", "--shading", "unlit", "--size", "4x4", "--device", "cpu"];
    let mut watching = Watching::start(&folder, &[&["render", "kb", "--out", "o.png"], &view[..]].concat());
    let color = || read(&folder.join("o.png")).2[5];
    watching.run();
    assert_eq!(color(), [255, 0, 0, 255]);
    material("0 0 1");
    assert_eq!(watching.run(), "note: done; watching 2 files\n");
    assert_eq!(color(), [0, 0, 255, 255]);
    // In front of the near plane.
    model(-0.25);
    assert!(watching.run().contains("the image is empty"));
    assert_eq!(color(), [255; 4]);
}

#[test]
fn a_command_without_a_file_to_watch_is_rejected() {
    let folder = folder("rejected");
    let out = folder.join("out.png");
    let out = out.to_str().unwrap();
    for (arguments, expected) in [
        (&["generate", "kb", "--target", "wgsl", "--out", out][..], "give a .fragbuf file"),
        (&["generate", "--all", "--target", "wgsl", "--out", out], "give a .fragbuf file"),
        (&["render", "kb", "--scene", "builtin:cubes", "--out", out], "or a model to `--scene`"),
        (&["render", "examples/csg.fragbuf", "--scene", "builtin:cubes", "--out", "-"], "give a file to `--out`"),
    ] {
        let output = fragbuf(&[arguments, &["--watch"]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0, "nothing is written");
}
