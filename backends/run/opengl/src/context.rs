//! Opens an OpenGL 4.5 context without a window or a display server: EGL's surfaceless platform, which Mesa has, or else the first device
//! that EGL lists and that opens, which is how the drivers of GPU vendors are reached.

use std::ffi::c_void;
use std::mem::transmute;

use glow::HasContext as _;
use khronos_egl as egl;

use crate::Error;

type Egl = egl::DynamicInstance<egl::EGL1_5>;

/// `EGL_PLATFORM_SURFACELESS_MESA`.
const SURFACELESS: egl::Enum = 0x31dd;
/// `EGL_PLATFORM_DEVICE_EXT`.
const DEVICE: egl::Enum = 0x313f;
/// No more devices than this are tried.
const MOST_DEVICES: usize = 16;

/// `eglQueryDevicesEXT`.
type QueryDevices = unsafe extern "system" fn(egl::Int, *mut *mut c_void, *mut egl::Int) -> egl::Boolean;

// Functions of OpenGL that glow lacks.
type SampleMask = unsafe extern "system" fn(u32, u32);
type ClearBuffer = unsafe extern "system" fn(u32, u32, u32, u32, *const c_void);
type ClearTexture = unsafe extern "system" fn(u32, i32, u32, u32, *const c_void);
type FramebufferParameter = unsafe extern "system" fn(u32, u32, i32);

/// An OpenGL context, current on the thread that opened it.
pub struct Context {
    /// The functions of OpenGL.
    pub gl: glow::Context,
    /// The renderer and its version.
    pub name: String,
    pub(crate) sample_mask: SampleMask,
    pub(crate) clear_buffer: ClearBuffer,
    pub(crate) clear_texture: ClearTexture,
    pub(crate) framebuffer_parameter: FramebufferParameter,
    egl: Egl,
    display: egl::Display,
    context: egl::Context,
}

impl Context {
    /// Opens a context and makes it current. Window coordinates count from the upper left corner, so the first row of a texture is the
    /// upper row of the image. Generated vertex shaders convert depth to the range of OpenGL themselves.
    pub fn surfaceless() -> Result<Self, Error> {
        let failed = |what: &str, error: &dyn std::fmt::Display| Error(format!("no OpenGL: {what}: {error}"));
        // SAFETY: the library is the system's EGL, whose initialisers may run.
        let egl = unsafe { Egl::load_required() }.map_err(|error| failed("libEGL.so.1 with EGL 1.5", &error))?;
        let display = open_display(&egl).map_err(|error| failed("the surfaceless platform", &error))?;
        egl.bind_api(egl::OPENGL_API).map_err(|error| failed("eglBindAPI", &error))?;
        let wanted = [egl::SURFACE_TYPE, egl::PBUFFER_BIT, egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::NONE];
        let config = egl.choose_first_config(display, &wanted).map_err(|error| failed("eglChooseConfig", &error))?;
        let config = config.ok_or_else(|| Error("no OpenGL: no configuration for it".to_owned()))?;
        let version = [
            egl::CONTEXT_MAJOR_VERSION,
            4,
            egl::CONTEXT_MINOR_VERSION,
            5,
            egl::CONTEXT_OPENGL_PROFILE_MASK,
            egl::CONTEXT_OPENGL_CORE_PROFILE_BIT,
            egl::NONE,
        ];
        let context = egl.create_context(display, config, None, &version);
        let context = context.map_err(|error| failed("a context of version 4.5", &error))?;
        egl.make_current(display, None, None, Some(context)).map_err(|error| failed("eglMakeCurrent", &error))?;
        let address =
            |name: &str| egl.get_proc_address(name).map_or(std::ptr::null(), |function| function as *const c_void);
        // SAFETY: the addresses are those of the current context.
        let gl = unsafe { glow::Context::from_loader_function(address) };
        // SAFETY: the context is current, and OpenGL 4.5 has these functions with these types.
        unsafe {
            let function = |name: &str| match egl.get_proc_address(name) {
                Some(function) => Ok(function as *const c_void),
                None => Err(Error(format!("no OpenGL: no function {name}"))),
            };
            let clip_control: unsafe extern "system" fn(u32, u32) = transmute(function("glClipControl")?);
            clip_control(glow::UPPER_LEFT, glow::NEGATIVE_ONE_TO_ONE);
            Ok(Context {
                name: format!(
                    "{}, {}",
                    gl.get_parameter_string(glow::RENDERER),
                    gl.get_parameter_string(glow::VERSION)
                ),
                sample_mask: transmute::<*const c_void, SampleMask>(function("glSampleMaski")?),
                clear_buffer: transmute::<*const c_void, ClearBuffer>(function("glClearNamedBufferData")?),
                clear_texture: transmute::<*const c_void, ClearTexture>(function("glClearTexImage")?),
                framebuffer_parameter: transmute::<*const c_void, FramebufferParameter>(function(
                    "glFramebufferParameteri",
                )?),
                gl,
                egl,
                display,
                context,
            })
        }
    }
}

/// Returns an initialised display, of the surfaceless platform where that has one.
fn open_display(egl: &Egl) -> Result<egl::Display, egl::Error> {
    let surfaceless = open_platform(egl, SURFACELESS, egl::DEFAULT_DISPLAY);
    surfaceless.or_else(|error| {
        let mut devices = devices(egl).into_iter();
        devices.find_map(|device| open_platform(egl, DEVICE, device).ok()).ok_or(error)
    })
}

fn open_platform(egl: &Egl, platform: egl::Enum, native: *mut c_void) -> Result<egl::Display, egl::Error> {
    // SAFETY: the native display is the default one or a device that EGL listed.
    let display = unsafe { egl.get_platform_display(platform, native, &[egl::ATTRIB_NONE]) }?;
    egl.initialize(display)?;
    Ok(display)
}

/// The devices of `EGL_EXT_device_enumeration`, none where EGL lacks it.
fn devices(egl: &Egl) -> Vec<*mut c_void> {
    let Some(query) = egl.get_proc_address("eglQueryDevicesEXT") else { return Vec::new() };
    // SAFETY: the function of this name has this type.
    let query: QueryDevices = unsafe { transmute(query) };
    let mut devices = [std::ptr::null_mut(); MOST_DEVICES];
    let mut count = 0;
    // SAFETY: the array has room for as many devices as the call may write.
    let found = unsafe { query(MOST_DEVICES as egl::Int, devices.as_mut_ptr(), &raw mut count) };
    let count = if found == egl::TRUE { count.clamp(0, MOST_DEVICES as egl::Int) as usize } else { 0 };
    devices[..count].to_vec()
}

impl Context {
    /// Whether the driver has an extension.
    pub fn has(&self, extension: &str) -> bool {
        self.gl.supported_extensions().contains(extension)
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // A context that cannot be released is lost anyway.
        let _ = self.egl.make_current(self.display, None, None, None);
        let _ = self.egl.destroy_context(self.display, self.context);
    }
}
