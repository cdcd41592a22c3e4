//! Tests `fragbuf::build` in a build script: a small crate builds and runs, repeats no work, and fails on an invalid description.
//! Layouts are compared with those that naga computes from the generated source.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::build::{Build, bindings};
use fragbuf::load::Description;
use fragbuf::{Form, Registry, Request, TARGETS, Target, generate, target};

use crate::cases::{checked, named};

const MANIFEST: &str = "
[package]
name = \"glass\"
version = \"0.0.0\"
edition = \"2024\"
publish = false

[build-dependencies]
fragbuf = { path = \"ROOT\", default-features = false }

[workspace]
";

/// The script of the guide.
pub const SCRIPT: &str = "
fn main() -> Result<(), fragbuf::build::Error> {
    fragbuf::build::Build::new()
        .file(\"shaders/glass.fragbuf\")
        .file(\"shaders/first_k.fragbuf\")
        .technique(\"ab_sb\")
        .set(\"sort\", \"bitonic\")
        .targets(&[\"wgsl\", \"spirv\", \"glsl-vulkan\"])
        .emit()?;
    Ok(())
}
";

const MAIN: &str = r##"
#![deny(warnings)]
include!(concat!(env!("OUT_DIR"), "/fragbuf.rs"));

/// A size known at compile time.
const KEYS: u64 = glass::plan::buffers::keys::bytes(640, 480, 8);

fn main() {
    // 4 bytes, k slots of every pixel.
    assert_eq!(KEYS, 4 * 8 * 640 * 480);
    // The value words are colour and id.
    assert_eq!(glass::plan::buffers::entries::bytes(640, 480, 8), 4 * 2 * 8 * 640 * 480);
    assert_eq!(ab_sb::plan::buffers::offsets::bytes(3, 5), 4 * 16);
    assert_eq!(ab_sb::plan::buffers::block_sums::bytes(1024, 2), 4 * 2);
    assert_eq!(first_k::wgsl::plan::buffers::taken::bytes(7, 3), 4 * 21);
    assert!(glass::wgsl::store::FRAGMENT.contains(glass::wgsl::store::FRAGMENT_ENTRY_POINT));
    assert!(glass::glsl_vulkan::store::FRAGMENT.starts_with("#version 450"));
    assert_eq!(glass::spirv::store::FRAGMENT[..4], [0x03, 0x02, 0x23, 0x07]);
    assert_eq!(ab_sb::wgsl::scan_sums::COMPUTE_ENTRY_POINT, "scan_sums");
    assert_eq!((glass::plan::GROUP, glass::plan::uniforms::CUT_OFFSET, glass::plan::uniforms::EYE_OFFSET), (0, 0, 16));
    println!("ran");
}
"##;

const GLASS: &str = "buffer Glass from kplus_array {
    fragment { color: rgba8, depth: f32, id: u32 }
    uniform { cut: f32, eye: vec3 }
    where |f, u| f.depth > u.cut + u.eye.x;
}
";

struct Crate {
    root: PathBuf,
    target: PathBuf,
}

impl Crate {
    fn new() -> Self {
        let temporary = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let this = Path::new(env!("CARGO_MANIFEST_DIR"));
        let root = temporary.join("glass");
        let _ = std::fs::remove_dir_all(&root);
        let created = Crate { root, target: temporary.parent().unwrap().to_owned() };
        created.write("Cargo.toml", &MANIFEST.replace("ROOT", &this.display().to_string()));
        created.write("build.rs", SCRIPT);
        created.write("src/main.rs", MAIN);
        created.write("shaders/glass.fragbuf", GLASS);
        for name in ["first_k.fragbuf", "first_k.wgsl"] {
            let text = std::fs::read_to_string(this.join("examples/user_storage").join(name)).unwrap();
            created.write(&format!("shaders/{name}"), &text);
        }
        // Uses the dependency versions of this workspace, so no network is needed.
        std::fs::copy(this.join("Cargo.lock"), created.root.join("Cargo.lock")).unwrap();
        created
    }

    fn write(&self, path: &str, text: &str) {
        let path = self.root.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    fn edit(&self, path: &str, from: &str, to: &str) {
        let text = std::fs::read_to_string(self.root.join(path)).unwrap();
        assert!(text.contains(from), "{path} has no {from}");
        self.write(path, &text.replace(from, to));
    }

    /// Runs cargo and returns its output and stderr.
    fn cargo(&self, arguments: &[&str]) -> (Output, String) {
        let output = Command::new(env!("CARGO"))
            .args(arguments)
            .arg("--offline")
            .current_dir(&self.root)
            .env("CARGO_TARGET_DIR", &self.target)
            .output()
            .unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        (output, stderr)
    }

    /// Builds the crate and returns whether the build script ran.
    fn ran_script(&self) -> bool {
        let (output, stderr) = self.cargo(&["build", "--verbose"]);
        assert!(output.status.success(), "{stderr}");
        stderr
            .lines()
            .any(|line| line.contains("Running") && line.contains("build-script-build") && line.contains("glass"))
    }

    /// Returns the generated files with their modification times.
    fn written(&self) -> BTreeMap<PathBuf, std::time::SystemTime> {
        let mut found = BTreeMap::new();
        let mut waiting = vec![self.target.join("debug/build")];
        while let Some(folder) = waiting.pop() {
            for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
                let path = entry.path();
                match path.is_dir() {
                    true => waiting.push(path),
                    false
                        if path.to_string_lossy().contains("/fragbuf")
                            && path.to_string_lossy().contains("/glass-") =>
                    {
                        let _ = found.insert(path, entry.metadata().unwrap().modified().unwrap());
                    }
                    false => {}
                }
            }
        }
        found
    }
}

#[test]
fn a_crate_with_a_build_script_builds_runs_and_repeats_no_work() {
    let glass = Crate::new();
    let (output, stderr) = glass.cargo(&["run"]);
    assert!(output.status.success() && output.stdout == b"ran\n", "{stderr}");
    let first = glass.written();
    assert!(first.len() > 20, "{first:?}");
    assert!(!glass.ran_script(), "nothing has changed");

    // The description changes: the script runs and writes only files that differ.
    glass.edit("shaders/glass.fragbuf", "f.depth > u.cut", "f.depth >= u.cut");
    assert!(glass.ran_script());
    let second = glass.written();
    let touched: Vec<&PathBuf> =
        second.iter().filter(|(path, time)| first.get(*path) != Some(time)).map(|(path, _)| path).collect();
    assert!(!touched.is_empty());
    assert!(
        touched
            .iter()
            .all(|path| path.to_string_lossy().contains("/glass/") && path.to_string_lossy().contains("store")),
        "{touched:?}"
    );

    // The user's WGSL file is a dependency too.
    glass.edit("shaders/first_k.wgsl", "// The first k fragments", "// The k first fragments");
    assert!(glass.ran_script());
    assert!(!glass.ran_script(), "nothing has changed");

    // An error fails the build and is reported with its span.
    glass.edit("shaders/glass.fragbuf", "u.cut", "u.cutt");
    let (output, stderr) = glass.cargo(&["build"]);
    assert!(!output.status.success());
    assert!(stderr.contains("error[unknown-field]") && stderr.contains("shaders/glass.fragbuf:4:31"), "{stderr}");
    glass.edit("shaders/glass.fragbuf", "u.cutt", "u.cut");
    glass.edit("shaders/first_k.wgsl", "//: provides", "//: ofers");
    let (output, stderr) = glass.cargo(&["build"]);
    assert!(!output.status.success());
    assert!(stderr.contains("error[invalid-row]") && stderr.contains("shaders/first_k.wgsl:11:5"), "{stderr}");
}

/// Compares offsets of fields and sizes of blocks with the layout that naga computes from the source, for every named case.
#[test]
fn layouts_are_those_that_naga_computes() {
    let mut compared = 0;
    for (name, description, set) in named() {
        let variant = checked(&description, &set).unwrap();
        let targets: Vec<&'static Target> = vec![target("wgsl-native").unwrap()];
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 4 };
        let Ok(generation) = generate(&variant, &request, &Registry::builtin()) else { panic!("{name}") };
        let bound = bindings("variant", name, &generation, 4, "files");
        for file in &generation.files {
            let module = naga::front::wgsl::parse_str(&String::from_utf8(file.bytes.clone()).unwrap());
            // Coherent buffers need naga options that this test does not set.
            let Ok(module) = module else { continue };
            for (_, variable) in module.global_variables.iter() {
                let Some(binding) = &variable.binding else { continue };
                assert_eq!(binding.group, 4);
                let block = variable.name.as_deref().unwrap();
                let text = part(&bound, block);
                assert!(text.contains(&format!("BINDING: u32 = {};", binding.binding)), "{name}: {block} in {text}");
                if let naga::TypeInner::Struct { members, .. } = &module.types[variable.ty].inner {
                    for member in members.iter().filter(|_| block != "camera") {
                        let field = member.name.as_deref().unwrap().to_uppercase();
                        // WGSL keywords get one more underscore in the source.
                        let line = |field: &str| format!("{field}_OFFSET: u64 = {};", member.offset);
                        let (exact, bare) = (line(&field), line(field.trim_end_matches('_')));
                        assert!(text.contains(&exact) || text.contains(&bare), "{name}: no `{exact}` in {text}");
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Returns the text of the module of this name.
fn part<'a>(text: &'a str, name: &str) -> &'a str {
    let start = text.find(&format!("pub mod {name} {{")).unwrap_or_else(|| panic!("no `{name}` in {text}"));
    let rest = &text[start + 8..];
    &rest[..rest.find("pub mod").unwrap_or(rest.len())]
}

#[test]
fn invalid_builds_have_error_messages() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bindings");
    let error = |build: Build| build.out_dir(&out).emit().unwrap_err().to_string();
    assert!(error(Build::new().technique("kb").targets(&["wgls"])).contains("no target `wgls`"));
    assert!(error(Build::new().technique("kb").technique("kb")).contains("module `kb`"));
    assert!(error(Build::new().technique("kbb")).contains("did you mean `kb`?"));
    assert!(
        error(Build::new().technique("kplus_array").set("sync", "interlock")).contains("error[unsupported-target]")
    );
    assert!(error(Build::new().file("no/such.fragbuf")).contains("no/such.fragbuf"));
}

/// Names of a description may differ only by case. Their Rust constants must be distinct.
#[test]
fn names_that_differ_only_by_case_stay_distinct() {
    let text = "buffer B from ab_ll { fragment { color: rgba8, depth: f32, Color: f32, position: f32 }
        uniform { cut: f32, Cut: u32 } where |f, u| f.Color + f.position > u.cut && u.Cut > 0; }";
    let variant = checked(&crate::cases::text(text), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &Registry::builtin()).unwrap();
    let bound = bindings("variant", "case", &generation, 0, "files");
    for line in
        ["CUT_OFFSET: u64 = 0;", "CUT_OFFSET_: u64 = 4;", "COLOR: u32 = 1;", "COLOR_: u32 = 2;", "POSITION_: u32 = 3;"]
    {
        assert!(bound.contains(&format!("pub const {line}")), "{line} in {bound}");
    }
}

/// Targets with different plans have the bindings of their plan.
#[test]
fn an_alternative_has_its_own_plan() {
    let (_, description, set) = named().into_iter().find(|(name, ..)| *name == "interlock_else_lock").unwrap();
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&checked(&description, &set).unwrap(), &request, &Registry::builtin()).unwrap();
    let bound = bindings("variant", "case", &generation, 0, "files");
    let (first, rest) = bound.split_once("pub mod plan_1 {").unwrap();
    let (second, targets) = rest.split_once("pub mod wgsl {").unwrap();
    assert!(first.contains("pub mod locks") && !second.contains("pub mod locks"));
    assert!(part(targets, "glsl").contains("pub use super::plan_1 as plan;"));
}

/// A user file whose names are keywords of Rust, differ only by case, or are not in Rust's style.
fn odd_names() -> Description {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("odd_names");
    std::fs::create_dir_all(&folder).unwrap();
    let first_k = std::fs::read_to_string("examples/user_storage/first_k.wgsl").unwrap();
    let more = "//: parameter box box = 3, from 1 to 9
//: parameter limit limit = 3, from 1 to 9
//: buffer Taken[pixel < n + fragments + kept + box]: word
//: buffer dyn[pixel < pixels]: word
//: pass store: ";
    let row =
        first_k.replacen("//: pass store: ", more, 1).replacen("slots plain", "slots plain, Taken plain, dyn plain", 1);
    std::fs::write(folder.join("odd.wgsl"), row).unwrap();
    let description = "buffer Odd { storage: wgsl(\"odd.wgsl\"); keep 8; }";
    std::fs::write(folder.join("odd.fragbuf"), description).unwrap();
    Description::read(&folder.join("odd.fragbuf")).unwrap()
}

/// Compiles the bindings of every technique and named case, in a library and in a private module of a program, with warnings as
/// errors, and computes sizes and their parameters in constants.
#[test]
fn bindings_of_every_technique_compile_without_warnings() {
    let registry = Registry::builtin();
    let techniques = registry.techniques().iter().map(|technique| technique.key.clone());
    let techniques = techniques.map(|key| (key.clone(), Description::Technique(key), vec![]));
    let cases = named().into_iter().map(|(name, description, set)| (name.to_owned(), description, set));
    let odd = ("odd_names".to_owned(), odd_names(), vec![]);
    let targets: Vec<&'static Target> = ["wgsl", "wgsl-native", "glsl"].map(|name| target(name).unwrap()).into();
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("all_bindings");
    let (mut text, mut modules) = (String::new(), BTreeSet::new());
    for (name, description, set) in
        techniques.chain(cases).chain([odd]).filter(|(name, ..)| modules.insert(name.clone()))
    {
        let variant = checked(&description, &set).unwrap_or_else(|errors| panic!("{name}: {errors}"));
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        let generation = generate(&variant, &request, &registry).unwrap_or_else(|errors| panic!("{name}: {errors}"));
        for file in &generation.files {
            let path = root.join("files").join(&name).join(&file.path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, &file.bytes).unwrap();
        }
        text.push_str(&bindings(&name, &name, &generation, 0, &format!("files/{name}")));
    }
    std::fs::write(root.join("fragbuf.rs"), text).unwrap();
    const USES: &str = "const _: () = {
        assert!(shaders::ab_array::plan::defaults::n(4, 3, 25) == 3);
        assert!(shaders::ab_array::plan::buffers::entries::bytes(4, 3, 3) == 4 * 2 * 3 * 12);
        assert!(shaders::kplus_array::plan::defaults::k() == 8);
        assert!(shaders::odd_names::plan::buffers::taken_::bytes(1, 2, 3) == 4 * 9);
        assert!(shaders::odd_names::plan::box_ + shaders::odd_names::plan::limit == 6);
    };";
    let library =
        format!("//! Bindings.\n#![allow(missing_docs)]\npub mod shaders {{ include!(\"fragbuf.rs\"); }}\n{USES}");
    let program = format!("mod shaders {{ include!(\"fragbuf.rs\"); }}\n{USES}\nfn main() {{}}\n");
    for (kind, main) in [("lib", library), ("bin", program)] {
        let path = root.join(format!("{kind}.rs"));
        std::fs::write(&path, main).unwrap();
        let lints = ["-D", "warnings", "-D", "unused", "-D", "unreachable_pub", "-D", "nonstandard_style"];
        let rustc = Command::new("rustc")
            .args(["--edition", "2024", "--crate-type", kind, "--emit", "metadata"])
            .args(lints)
            .arg(&path)
            .current_dir(&root)
            .output()
            .unwrap();
        assert!(rustc.status.success(), "{}", String::from_utf8_lossy(&rustc.stderr));
    }
}
