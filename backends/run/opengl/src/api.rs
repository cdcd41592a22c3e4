//! The differences between OpenGL and OpenGL ES. All other files use what OpenGL 4.5 and OpenGL ES 3.1 have in common.
//!
//! Input: the API that a caller selects. Output: how EGL opens it, the target whose files it compiles, the first lines of a shader, and the
//! functions and formats that one of them lacks.

use std::ffi::c_void;
use std::fmt;
use std::mem::transmute;
use std::ptr::from_ref;

use glow::HasContext as _;
use khronos_egl as egl;

use crate::Error;
use crate::memory::Format;

/// An API that this host draws with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Api {
    /// OpenGL 4.5, core profile.
    OpenGl,
    /// OpenGL ES 3.1.
    OpenGlEs,
}

impl fmt::Display for Api {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Api::OpenGl => "OpenGL",
            Api::OpenGlEs => "OpenGL ES",
        })
    }
}

/// `glClearNamedBufferData`.
type ClearBuffer = unsafe extern "system" fn(u32, u32, u32, u32, *const c_void);
/// `glClearTexImage`.
type ClearTexture = unsafe extern "system" fn(u32, i32, u32, u32, *const c_void);

/// Functions that OpenGL ES lacks.
pub(crate) struct Desktop {
    pub clear_buffer: ClearBuffer,
    pub clear_texture: ClearTexture,
}

/// OpenGL ES fills a buffer from an upload of at most this many words. Each copy then doubles what is filled.
const CHUNK: u64 = 1 << 16;

impl Api {
    /// The target of fragbuf whose files the API compiles.
    pub fn target(self) -> &'static str {
        match self {
            Api::OpenGl => "glsl",
            Api::OpenGlEs => "glsl-es",
        }
    }

    /// The first lines of a shader in module form: the version, and in OpenGL ES the precision, which fragment shaders lack there.
    pub fn shader_header(self) -> &'static str {
        match self {
            Api::OpenGl => "#version 450\n",
            Api::OpenGlEs => "#version 310 es\nprecision highp float;\nprecision highp int;\n",
        }
    }

    /// The format of the image. Blending of 32-bit floats is an extension of OpenGL ES, which few drivers have.
    pub(crate) fn output(self) -> Format {
        match self {
            Api::OpenGl => Format::color(glow::RGBA32F),
            Api::OpenGlEs => Format::color(glow::RGBA16F),
        }
    }

    /// The extension that attaches the image, core from OpenGL ES 3.2 on.
    pub(crate) fn extension_of_output(self) -> Option<&'static str> {
        (self == Api::OpenGlEs).then_some("GL_EXT_color_buffer_float")
    }

    /// Tests whether a version of the API contains an extension.
    pub(crate) fn contains(self, extension: &str, (major, minor): (u32, u32)) -> bool {
        let is_core = ["GL_EXT_color_buffer_float", "GL_EXT_draw_buffers_indexed"].contains(&extension);
        self == Api::OpenGlEs && (major, minor) >= (3, 2) && is_core
    }

    pub(crate) fn egl_api(self) -> egl::Enum {
        match self {
            Api::OpenGl => egl::OPENGL_API,
            Api::OpenGlEs => egl::OPENGL_ES_API,
        }
    }

    /// The bit of `EGL_RENDERABLE_TYPE`.
    pub(crate) fn egl_bit(self) -> egl::Int {
        match self {
            Api::OpenGl => egl::OPENGL_BIT,
            Api::OpenGlEs => egl::OPENGL_ES3_BIT,
        }
    }

    /// The least version.
    pub(crate) fn version(self) -> [egl::Int; 2] {
        match self {
            Api::OpenGl => [4, 5],
            Api::OpenGlEs => [3, 1],
        }
    }

    /// The attributes of a context. Drivers may open a later version.
    pub(crate) fn egl_attributes(self) -> Vec<egl::Int> {
        let [major, minor] = self.version();
        let mut attributes = vec![egl::CONTEXT_MAJOR_VERSION, major, egl::CONTEXT_MINOR_VERSION, minor];
        if self == Api::OpenGl {
            attributes.extend([egl::CONTEXT_OPENGL_PROFILE_MASK, egl::CONTEXT_OPENGL_CORE_PROFILE_BIT]);
        }
        attributes.push(egl::NONE);
        attributes
    }

    /// Loads the functions that OpenGL ES lacks; `None` there.
    ///
    /// # Safety
    ///
    /// `function` returns the functions of the API by their names.
    pub(crate) unsafe fn desktop(
        self,
        function: &dyn Fn(&str) -> Result<*const c_void, Error>,
    ) -> Result<Option<Desktop>, Error> {
        if self == Api::OpenGlEs {
            return Ok(None);
        }
        // SAFETY: OpenGL 4.5 has these functions with these types.
        unsafe {
            Ok(Some(Desktop {
                clear_buffer: transmute::<*const c_void, ClearBuffer>(function("glClearNamedBufferData")?),
                clear_texture: transmute::<*const c_void, ClearTexture>(function("glClearTexImage")?),
            }))
        }
    }
}

/// Sets every word of a buffer that has `words` words.
pub(crate) fn fill(gl: &glow::Context, desktop: Option<&Desktop>, buffer: glow::Buffer, words: u64, value: u32) {
    if let Some(desktop) = desktop {
        let word = from_ref(&value).cast();
        // SAFETY: the context is current, and a buffer has whole words.
        unsafe { (desktop.clear_buffer)(buffer.0.get(), glow::R32UI, glow::RED_INTEGER, glow::UNSIGNED_INT, word) };
        return;
    }
    let first = words.min(CHUNK);
    let bytes: Vec<u8> = std::iter::repeat_n(value.to_le_bytes(), first as usize).flatten().collect();
    // SAFETY: the context is current, and every range lies inside the buffer. The ranges of a copy do not overlap.
    unsafe {
        gl.bind_buffer(glow::COPY_READ_BUFFER, Some(buffer));
        gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(buffer));
        gl.buffer_sub_data_u8_slice(glow::COPY_WRITE_BUFFER, 0, &bytes);
        let mut filled = first;
        while filled < words {
            let count = filled.min(words - filled);
            let [to, bytes] = [filled, count].map(|words| 4 * words as i32);
            gl.copy_buffer_sub_data(glow::COPY_READ_BUFFER, glow::COPY_WRITE_BUFFER, 0, to, bytes);
            filled += count;
        }
    }
}
