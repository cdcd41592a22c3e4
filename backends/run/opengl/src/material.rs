//! Shaders of the caller in front of which the functions of a buffer are put: passes in module form.
//!
//! Input: the caller's sources, and the text of a geometry pass. Output: the sources of a program. Nothing here calls OpenGL.

use fragbuf_follow::manifest::{File, VertexInput};

use crate::Api;

/// The uniform that has the matrix of the scene: to the clip space of OpenGL, with z from -w to w, and upside down.
pub(crate) const MATRIX: &str = "view_projection";

/// A material: the caller's own shaders for passes in module form. Both sources are without `#version`, so one material is for both APIs.
#[derive(Clone, Debug)]
pub struct Material {
    /// The vertex shader. It may have `uniform mat4 view_projection`, which maps positions of the scene to `gl_Position`.
    pub vertex: String,
    /// The fragment shader, whose `main` calls `store_fragment` (behind the prefix of the buffer).
    pub fragment: String,
    /// What a vertex of the scene consists of. The first input is the position, three floats.
    pub inputs: Vec<VertexInput>,
}

impl Material {
    /// Returns the sources of a geometry pass, vertex stage first. `module` is the text of `file`.
    pub(crate) fn sources(&self, api: Api, prefix: &str, file: &File, module: &str) -> [String; 2] {
        let header = api.shader_header();
        let (version, precision) = header.split_once('\n').unwrap_or((header, ""));
        // Extensions come before everything but the version.
        let is_extension = |line: &str| line.is_empty() || line.starts_with("#extension ");
        let end = module.split_inclusive('\n').take_while(|line| is_extension(line.trim_end())).map(str::len).sum();
        let (extensions, functions) = module.split_at(end);
        let called = if prefix.is_empty() { "store_fragment".to_owned() } else { format!("{prefix}_store_fragment") };
        let renamed = match file.entry_point == called {
            true => String::new(),
            false => format!("#define {called} {}\n", file.entry_point),
        };
        // Messages of the driver have the caller's own line numbers; most drivers name source 1 with them.
        let own = "#line 1 1\n";
        [
            format!("{version}\n{precision}{own}{}", self.vertex),
            format!("{version}\n{extensions}{precision}{functions}{renamed}{own}{}", self.fragment),
        ]
    }
}
