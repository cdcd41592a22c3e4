//! Compiles the files of a pass.

use glow::HasContext as _;

use crate::Error;
use crate::manifest::File;

/// The extensions that a feature of the manifest needs beyond OpenGL 4.5.
const EXTENSIONS: [(&str, &[&str]); 3] = [
    ("u64-atomics", &["GL_ARB_gpu_shader_int64", "GL_NV_shader_atomic_int64"]),
    ("interlock", &["GL_ARB_fragment_shader_interlock"]),
    ("ordered-interlock", &["GL_ARB_fragment_shader_interlock"]),
];

/// Checks that the driver has every feature of a plan.
pub fn check_features(gl: &glow::Context, features: &[String]) -> Result<(), Error> {
    let has = gl.supported_extensions();
    let needed = EXTENSIONS.iter().filter(|(feature, _)| features.iter().any(|needed| needed == feature));
    let missing: Vec<&str> = needed.flat_map(|(_, all)| *all).copied().filter(|one| !has.contains(*one)).collect();
    if missing.is_empty() { Ok(()) } else { Err(Error(format!("the driver lacks {}", missing.join(" and ")))) }
}

/// Compiles and links the files of one pass.
pub fn compile(
    gl: &glow::Context,
    files: &[&File],
    read: &dyn Fn(&str) -> Result<String, Error>,
) -> Result<glow::Program, Error> {
    let mut sources = Vec::with_capacity(files.len());
    for file in files {
        let stage = match file.stage.as_str() {
            "vertex" => glow::VERTEX_SHADER,
            "fragment" => glow::FRAGMENT_SHADER,
            "compute" => glow::COMPUTE_SHADER,
            other => return Err(Error(format!("{}: no stage `{other}` in OpenGL", file.path))),
        };
        sources.push((stage, &file.path, read(&file.path)?));
    }
    let sources: Vec<_> =
        sources.iter().map(|(stage, path, source)| (*stage, path.as_str(), source.as_str())).collect();
    link(gl, &sources)
}

/// Compiles and links sources, each with its stage and the path for messages.
pub fn link(gl: &glow::Context, sources: &[(u32, &str, &str)]) -> Result<glow::Program, Error> {
    // SAFETY: the context is current.
    unsafe {
        let program = gl.create_program().map_err(Error)?;
        for (stage, path, source) in sources {
            let shader = gl.create_shader(*stage).map_err(Error)?;
            gl.shader_source(shader, source);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                return Err(Error(format!("{path}: {}", gl.get_shader_info_log(shader))));
            }
            gl.attach_shader(program, shader);
            gl.delete_shader(shader);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            let paths: Vec<&str> = sources.iter().map(|(_, path, _)| *path).collect();
            return Err(Error(format!("{}: {}", paths.join(", "), gl.get_program_info_log(program))));
        }
        Ok(program)
    }
}
