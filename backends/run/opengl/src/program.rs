//! Compiles the files of a pass.

use fragbuf_follow::manifest::File;
use glow::HasContext as _;

use crate::{Context, Error, Material};

/// Compiles and links the files of one pass. A file in module form becomes a part of the material.
pub fn compile(
    context: &Context,
    files: &[&File],
    read: &dyn Fn(&str) -> Result<String, Error>,
    material: Option<(&Material, &str)>,
) -> Result<glow::Program, Error> {
    let mut sources = Vec::with_capacity(files.len());
    for file in files {
        let text = read(&file.path)?;
        let path = file.path.clone();
        match (file.stage.as_str(), material) {
            ("vertex", _) => sources.push((glow::VERTEX_SHADER, path, text)),
            ("fragment", _) => sources.push((glow::FRAGMENT_SHADER, path, text)),
            ("compute", _) => sources.push((glow::COMPUTE_SHADER, path, text)),
            ("module", Some((material, prefix))) => {
                let [vertex, fragment] = material.sources(context.api, prefix, file, &text);
                sources.push((glow::VERTEX_SHADER, "the material's vertex shader".to_owned(), vertex));
                sources.push((glow::FRAGMENT_SHADER, format!("the material's fragment shader with {path}"), fragment));
            }
            ("module", None) => return Err(Error(format!("{path} is in module form: it needs a material"))),
            (other, _) => return Err(Error(format!("{path}: no stage `{other}` in {}", context.api))),
        }
    }
    let sources: Vec<_> = sources.iter().map(|(stage, path, text)| (*stage, path.as_str(), text.as_str())).collect();
    link(&context.gl, &sources)
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
            gl.attach_shader(program, shader);
            // It lives as long as the program.
            gl.delete_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                let error = Error(format!("{path}: {}", gl.get_shader_info_log(shader)));
                gl.delete_program(program);
                return Err(error);
            }
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            let paths: Vec<&str> = sources.iter().map(|(_, path, _)| *path).collect();
            let error = Error(format!("{}: {}", paths.join(", "), gl.get_program_info_log(program)));
            gl.delete_program(program);
            return Err(error);
        }
        Ok(program)
    }
}
