//! A device that runs GLSL: OpenGL 4.5 without a window.

use fragbuf_glsl::{Dialect, Options, Slot, Unit, print};
use fragbuf_opengl_host::Context;

use super::comparison::Shader;

thread_local! {
    /// A context belongs to one thread.
    static CONTEXT: Context = Context::surfaceless()
        .unwrap_or_else(|error| panic!("{error}; install Debian's packages libegl1 and libgl1-mesa-dri"));
}

/// Runs a shader on the driver, printed as GLSL.
pub fn run(shader: &Shader) -> Result<Vec<u32>, String> {
    let options = Options {
        dialect: Dialect::OpenGl450,
        header: "",
        markers: &[],
        bindings: &|_, binding| Slot { set: 0, binding },
        plain_loads: &[],
        plain_functions: &[],
        written_first: &[],
        zero_workgroup_memory: false,
    };
    let source = print(&shader.module, &shader.info, &shader.source, Unit::EntryPoint("main"), &options);
    let source = source.map_err(|errors| format!("{errors:?}"))?;
    let results = CONTEXT.with(|context| context.compute(&source, &shader.inputs, shader.results, shader.groups));
    results.map_err(|error| format!("{error}\n{source}"))
}
