//! Shared by the tests: parses WGSL, prints GLSL and validates it with glslang and spirv-val.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::{Path, PathBuf};
use std::process::Command;

use fragbuf_glsl::{Dialect, Marker, Options, Slot, Unit, Unprintable};
use naga::ShaderStage;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// The markers, by the names of their functions.
pub const MARKERS: &[(&str, Marker)] = &[
    ("memory_fence", Marker::MemoryFence),
    ("is_helper_lane", Marker::HelperLane),
    ("critical_begin", Marker::CriticalBegin),
    ("ordered_critical_begin", Marker::OrderedCriticalBegin),
    ("critical_end", Marker::CriticalEnd),
];

/// Every dialect.
pub const ALL: [Dialect; 3] = [Dialect::OpenGl450, Dialect::Vulkan450, Dialect::Es310];

/// Parses and validates WGSL.
pub fn parse(source: &str) -> (naga::Module, ModuleInfo) {
    let options = naga::front::wgsl::Options { parse_doc_comments: true, capabilities: Capabilities::all() };
    let mut frontend = naga::front::wgsl::Frontend::new_with_options(options);
    let module = frontend.parse(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    (module, info)
}

/// Prints a unit without plain loads.
pub fn print(source: &str, unit: Unit, dialect: Dialect) -> Result<String, Vec<Unprintable>> {
    print_with(source, unit, dialect, (&[], &[]))
}

/// Prints a unit with globals whose loads may be plain, and functions whose accesses may be.
pub fn print_with(
    source: &str,
    unit: Unit,
    dialect: Dialect,
    (plain_loads, plain_functions): (&[&str], &[&str]),
) -> Result<String, Vec<Unprintable>> {
    let (module, info) = parse(source);
    let bindings = |group: u32, binding: u32| Slot { set: group, binding: group * 16 + binding };
    let options = Options {
        dialect,
        header: "",
        markers: MARKERS,
        bindings: &bindings,
        plain_loads,
        plain_functions,
        written_first: &[],
        zero_workgroup_memory: true,
    };
    fragbuf_glsl::print(&module, &info, source, unit, &options)
}

/// Returns the printed definition of a function.
pub fn function(text: &str, name: &str) -> String {
    let start = text.lines().position(|line| line.contains(&format!(" {name}(")) && line.ends_with('{'));
    let start = start.unwrap_or_else(|| panic!("no function {name} in\n{text}"));
    let lines: Vec<&str> = text.lines().skip(start).collect();
    let end = lines.iter().position(|line| *line == "}").unwrap();
    lines[..=end].join("\n") + "\n"
}

/// Returns the file extension of a stage.
pub fn suffix(stage: ShaderStage) -> &'static str {
    match stage {
        ShaderStage::Vertex => "vert",
        ShaderStage::Fragment => "frag",
        _ => "comp",
    }
}

/// Validates GLSL with glslang; for Vulkan, also the resulting SPIR-V with spirv-val.
pub fn accept(text: &str, name: &str, stage: &str, dialect: Dialect) -> Result<(), String> {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("glsl");
    std::fs::create_dir_all(&directory).unwrap();
    let label = format!("{dialect:?}").to_lowercase();
    let file = directory.join(format!("{name}.{label}.{stage}"));
    std::fs::write(&file, text).unwrap();
    match dialect {
        Dialect::OpenGl450 => run(Command::new("glslangValidator").args(["--target-env", "opengl"]).arg(&file)),
        Dialect::Es310 => run(Command::new("glslangValidator").arg(&file)),
        Dialect::Vulkan450 => {
            let binary: PathBuf = file.with_extension(format!("{stage}.spv"));
            run(Command::new("glslangValidator")
                .args(["-V", "--target-env", "vulkan1.1", "-o"])
                .arg(&binary)
                .arg(&file))?;
            run(Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(&binary))
        }
    }
    .map_err(|message| format!("{name}, {label}:\n{message}\n{text}"))
}

/// Runs a command; its output is the error.
fn run(command: &mut Command) -> Result<(), String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().unwrap_or_else(|error| panic!("{program} must be installed for this test: {error}"));
    if output.status.success() {
        return Ok(());
    }
    Err(format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr)))
}
