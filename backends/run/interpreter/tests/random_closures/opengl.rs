//! A device that runs GLSL: OpenGL 4.5 without a window, by EGL's surfaceless platform, which Mesa has.
#![allow(unsafe_code, reason = "every call of OpenGL is unsafe")]

use fragbuf_glsl::{Dialect, Options, Slot, Unit, print};
use glow::HasContext as _;
use khronos_egl as egl;

use super::comparison::Shader;

/// `EGL_PLATFORM_SURFACELESS_MESA`.
const SURFACELESS: egl::Enum = 0x31dd;

thread_local! {
    /// A context belongs to one thread.
    static GL: glow::Context = open();
}

/// Opens a context and makes it current.
fn open() -> glow::Context {
    const HELP: &str =
        "this test needs OpenGL 4.5 on EGL's surfaceless platform: Debian's `libegl1` and `libgl1-mesa-dri`";
    // SAFETY: the library is the system's EGL.
    let library = unsafe { egl::DynamicInstance::<egl::EGL1_5>::load_required() }.expect(HELP);
    // SAFETY: this platform has only the default display.
    let display = unsafe { library.get_platform_display(SURFACELESS, egl::DEFAULT_DISPLAY, &[egl::ATTRIB_NONE]) };
    let display = display.expect(HELP);
    library.initialize(display).expect(HELP);
    library.bind_api(egl::OPENGL_API).expect(HELP);
    let wanted = [egl::SURFACE_TYPE, egl::PBUFFER_BIT, egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::NONE];
    let config = library.choose_first_config(display, &wanted).expect(HELP).expect(HELP);
    let version = [egl::CONTEXT_MAJOR_VERSION, 4, egl::CONTEXT_MINOR_VERSION, 5, egl::NONE];
    let context = library.create_context(display, config, None, &version).expect(HELP);
    library.make_current(display, None, None, Some(context)).expect(HELP);
    let address = |name: &str| library.get_proc_address(name).map_or(std::ptr::null(), |found| found as *const _);
    // SAFETY: the context is current on this thread, where the functions are called.
    let gl = unsafe { glow::Context::from_loader_function(address) };
    // The context lives as long as its thread.
    std::mem::forget(library);
    gl
}

/// Runs a shader on the driver, printed as GLSL.
pub fn run(shader: &Shader) -> Result<Vec<u32>, String> {
    let options = Options {
        dialect: Dialect::OpenGl450,
        header: "",
        markers: &[],
        bindings: &|_, binding| Slot { set: 0, binding },
        plain_loads: &[],
        written_first: &[],
        zero_workgroup_memory: false,
    };
    let source = print(&shader.module, &shader.info, &shader.source, Unit::EntryPoint("main"), &options);
    let source = source.map_err(|errors| format!("{errors:?}"))?;
    GL.with(|gl| compute(gl, &source, &shader.inputs, shader.results, shader.groups))
}

fn compute(gl: &glow::Context, source: &str, inputs: &[u32], results: usize, groups: u32) -> Result<Vec<u32>, String> {
    let inputs: Vec<u8> = inputs.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let mut bytes = vec![0; results * 4];
    // SAFETY: the context is current, and the buffers are as long as the shader's indices require.
    unsafe {
        let unit = gl.create_shader(glow::COMPUTE_SHADER).unwrap();
        gl.shader_source(unit, source);
        gl.compile_shader(unit);
        if !gl.get_shader_compile_status(unit) {
            return Err(format!("{}\n{source}", gl.get_shader_info_log(unit)));
        }
        let program = gl.create_program().unwrap();
        gl.attach_shader(program, unit);
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            return Err(format!("{}\n{source}", gl.get_program_info_log(program)));
        }
        gl.use_program(Some(program));
        let buffers = [gl.create_buffer().unwrap(), gl.create_buffer().unwrap()];
        for (binding, (buffer, content)) in (0..).zip(buffers.iter().zip([&inputs, &bytes])) {
            gl.bind_buffer(glow::SHADER_STORAGE_BUFFER, Some(*buffer));
            gl.buffer_data_u8_slice(glow::SHADER_STORAGE_BUFFER, content, glow::STATIC_READ);
            gl.bind_buffer_base(glow::SHADER_STORAGE_BUFFER, binding, Some(*buffer));
        }
        gl.dispatch_compute(groups, 1, 1);
        gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
        gl.get_buffer_sub_data(glow::SHADER_STORAGE_BUFFER, 0, &mut bytes);
        assert_eq!(gl.get_error(), glow::NO_ERROR);
        gl.delete_program(program);
        gl.delete_shader(unit);
        buffers.into_iter().for_each(|buffer| gl.delete_buffer(buffer));
    }
    Ok(bytes.chunks_exact(4).map(|word| u32::from_ne_bytes(word.try_into().unwrap())).collect())
}
