//! Opens a context of OpenGL or OpenGL ES without a window or a display server: EGL's surfaceless platform, which Mesa has, or else the
//! first device that EGL lists and that opens, which is how the drivers of GPU vendors are reached.

use std::ffi::c_void;
use std::mem::transmute;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use glow::HasContext as _;
use khronos_egl as egl;

use crate::Error;
use crate::api::{Api, Desktop};

type Egl = egl::DynamicInstance<egl::EGL1_5>;

/// EGL, once per process. It is never unloaded: drivers register destructors of threads, which run when a thread ends and would then
/// be in unmapped memory.
static LIBRARY: OnceLock<Result<Egl, String>> = OnceLock::new();

/// Held while a context is opened or closed. Mesa 22.3 crashes if threads do that at the same time.
static CHANGING: Mutex<()> = Mutex::new(());

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
type FramebufferParameter = unsafe extern "system" fn(u32, u32, i32);

/// A context of OpenGL or OpenGL ES, current on the thread that opened it.
pub struct Context {
    /// The functions of OpenGL.
    pub gl: glow::Context,
    /// The renderer and its version.
    pub name: String,
    /// The API.
    pub api: Api,
    pub(crate) sample_mask: SampleMask,
    pub(crate) desktop: Option<Desktop>,
    pub(crate) framebuffer_parameter: FramebufferParameter,
    egl: &'static Egl,
    display: egl::Display,
    context: egl::Context,
}

impl Context {
    /// Opens OpenGL 4.5 and makes it current.
    pub fn surfaceless() -> Result<Self, Error> {
        Context::open(Api::OpenGl)
    }

    /// Opens a context and makes it current. `Host` turns the scene upside down, so that the first row of a texture is the upper row of the
    /// image; front faces are therefore clockwise in the window. Generated vertex shaders convert depth to the range of OpenGL themselves.
    pub fn open(api: Api) -> Result<Self, Error> {
        let failed = |what: &str, error: &dyn std::fmt::Display| Error(format!("no {api}: {what}: {error}"));
        let egl = library().map_err(|error| failed("libEGL.so.1 with EGL 1.5", &error))?;
        let _changing = changing();
        let display = open_display(egl).map_err(|error| failed("the surfaceless platform", &error))?;
        egl.bind_api(api.egl_api()).map_err(|error| failed("eglBindAPI", &error))?;
        let wanted = [egl::SURFACE_TYPE, egl::PBUFFER_BIT, egl::RENDERABLE_TYPE, api.egl_bit(), egl::NONE];
        let config = egl.choose_first_config(display, &wanted).map_err(|error| failed("eglChooseConfig", &error))?;
        let config = config.ok_or_else(|| Error(format!("no {api}: no configuration for it")))?;
        let context = egl.create_context(display, config, None, &api.egl_attributes());
        let [major, minor] = api.version();
        let context = context.map_err(|error| failed(&format!("a context of version {major}.{minor}"), &error))?;
        let current = egl.make_current(display, None, None, Some(context));
        let current = current.map_err(|error| failed("eglMakeCurrent", &error));
        let opened = current.and_then(|()| Context::load(egl, api, display, context));
        if opened.is_err() {
            close(egl, api, display, context);
        }
        opened
    }

    /// Loads the functions of a context that is current.
    fn load(egl: &'static Egl, api: Api, display: egl::Display, context: egl::Context) -> Result<Self, Error> {
        let function = |name: &str| {
            // Functions of extensions that a later version contains.
            let function = egl.get_proc_address(name).or_else(|| egl.get_proc_address(&format!("{name}EXT")));
            function.map(|function| function as *const c_void)
        };
        // SAFETY: the addresses are those of the current context.
        let gl = unsafe { glow::Context::from_loader_function(|name| function(name).unwrap_or(std::ptr::null())) };
        let function = |name: &str| function(name).ok_or_else(|| Error(format!("no {api}: no function {name}")));
        // SAFETY: the context is current, and both APIs have these functions with these types.
        unsafe {
            gl.front_face(glow::CW);
            Ok(Context {
                name: format!(
                    "{}, {}",
                    gl.get_parameter_string(glow::RENDERER),
                    gl.get_parameter_string(glow::VERSION)
                ),
                api,
                sample_mask: transmute::<*const c_void, SampleMask>(function("glSampleMaski")?),
                desktop: api.desktop(&function)?,
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

fn library() -> Result<&'static Egl, &'static String> {
    // SAFETY: the library is the system's EGL, whose initialisers may run.
    let load = || unsafe { Egl::load_required() }.map_err(|error| error.to_string());
    LIBRARY.get_or_init(load).as_ref()
}

/// Releases and destroys a context. The caller holds [`CHANGING`].
fn close(egl: &Egl, api: Api, display: egl::Display, context: egl::Context) {
    // A context that cannot be released is lost anyway. One that was opened later on this thread stays current.
    let _ = egl.bind_api(api.egl_api());
    if egl.get_current_context() == Some(context) {
        let _ = egl.make_current(display, None, None, None);
    }
    let _ = egl.destroy_context(display, context);
}

fn changing() -> MutexGuard<'static, ()> {
    // A thread that panicked meanwhile left nothing half done that another would read.
    CHANGING.lock().unwrap_or_else(PoisonError::into_inner)
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
    /// Tests whether the driver has an extension, or a version that contains it.
    pub fn has(&self, extension: &str) -> bool {
        let version = self.gl.version();
        self.gl.supported_extensions().contains(extension)
            || self.api.contains(extension, (version.major, version.minor))
    }

    /// Checks that the driver has every extension.
    pub(crate) fn require(&self, extensions: &[String]) -> Result<(), Error> {
        let missing: Vec<&str> = extensions.iter().map(String::as_str).filter(|one| !self.has(one)).collect();
        if missing.is_empty() { Ok(()) } else { Err(Error(format!("the driver lacks {}", missing.join(" and ")))) }
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        let _changing = changing();
        close(self.egl, self.api, self.display, self.context);
    }
}
