//! Opens Vulkan: the instance, the validation layer with its messages, and the choice of a device.
//!
//! Input: the settings of a caller. Output: a [`Context`]. The logical device depends on what a manifest requires, so
//! `gpu` creates it.

use std::ffi::{CStr, c_void};
use std::sync::{Mutex, PoisonError};

use ash::{ext, vk};

use crate::Error;

const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// How Vulkan is opened.
#[derive(Clone, Copy, Debug, Default)]
pub struct Settings<'a> {
    /// A part of the device's name, in any case. `None`: a discrete GPU before an integrated one, and that before
    /// others.
    pub device: Option<&'a str>,
    /// What the validation layer checks.
    pub validation: Validation,
    /// Requests features of extensions that the device has although it does not report them, as a mock driver, which
    /// runs nothing.
    pub assume_features: bool,
}

/// What the validation layer `VK_LAYER_KHRONOS_validation` checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Validation {
    /// Nothing: the layer is not loaded.
    #[default]
    Off,
    /// The use of the API. Each message is an error of the call that caused it.
    On,
    /// The same, and whether barriers separate accesses to the same memory.
    Synchronization,
}

/// A Vulkan instance and one of its physical devices.
pub struct Context {
    pub(crate) instance: ash::Instance,
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) assume_features: bool,
    /// The name of the device and the Vulkan version of its driver.
    pub name: String,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// The messages of the validation layer. The messenger has its address.
    messages: Box<Messages>,
    // The library is unloaded last.
    _entry: ash::Entry,
}

type Messages = Mutex<Vec<String>>;

impl Context {
    /// Opens Vulkan 1.1 or later and chooses a device.
    pub fn open(settings: &Settings<'_>) -> Result<Self, Error> {
        // SAFETY: the library is the system's Vulkan loader, whose initialisers may run.
        let entry = unsafe { ash::Entry::load() };
        Self::with(entry.map_err(|error| not_loaded(&error))?, settings)
    }

    fn with(entry: ash::Entry, settings: &Settings<'_>) -> Result<Self, Error> {
        let messages = Box::<Messages>::default();
        let instance = create_instance(&entry, settings.validation, &messages)?;
        let mut context = Context {
            instance,
            physical: vk::PhysicalDevice::null(),
            assume_features: settings.assume_features,
            name: String::new(),
            messenger: None,
            messages,
            _entry: entry,
        };
        if settings.validation != Validation::Off {
            let debug = ext::debug_utils::Instance::new(&context._entry, &context.instance);
            // SAFETY: the instance has the extension, and the messages outlive the messenger.
            let messenger = unsafe { debug.create_debug_utils_messenger(&messenger(&context.messages), None) };
            context.messenger = Some((debug, messenger.map_err(failed("a debug messenger"))?));
        }
        (context.physical, context.name) = choose(&context.instance, settings.device)?;
        context.check()?;
        Ok(context)
    }

    /// Returns an error with the messages of the validation layer since the last call, if there are some.
    pub fn check(&self) -> Result<(), Error> {
        let mut messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        match std::mem::take(&mut *messages).as_slice() {
            [] => Ok(()),
            messages => Err(Error(format!("validation: {}", messages.join("\nvalidation: ")))),
        }
    }

    /// The properties of the device.
    pub(crate) fn properties(&self) -> vk::PhysicalDeviceProperties {
        // SAFETY: the device is one of the instance.
        unsafe { self.instance.get_physical_device_properties(self.physical) }
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: hosts borrow the context, so that none of their objects is left.
        unsafe {
            if let Some((debug, messenger)) = self.messenger.take() {
                debug.destroy_debug_utils_messenger(messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

/// Returns a conversion of a result of Vulkan to an error about `what`.
pub(crate) fn failed(what: &str) -> impl Fn(vk::Result) -> Error {
    move |result| match result {
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY | vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
            Error(format!("out of memory for {what}: draw a smaller frame or slices of it, or keep fewer fragments"))
        }
        vk::Result::ERROR_DEVICE_LOST => {
            Error(format!("{what}: the device is lost: open another context and create another host"))
        }
        other => Error(format!("{what}: Vulkan returns {other}")),
    }
}

fn not_loaded(error: &dyn std::fmt::Display) -> Error {
    Error(format!("libvulkan.so.1 is not loaded ({error}): install Debian's package libvulkan1, and a driver"))
}

fn no_driver() -> Error {
    Error("Vulkan has no device: install a driver, such as Debian's package mesa-vulkan-drivers".to_owned())
}

fn create_instance(entry: &ash::Entry, validation: Validation, messages: &Messages) -> Result<ash::Instance, Error> {
    // SAFETY: the loader's functions have no preconditions.
    let version = unsafe { entry.try_enumerate_instance_version() }.map_err(failed("the version of Vulkan"))?;
    if version.is_none_or(|version| version < vk::API_VERSION_1_1) {
        return Err(Error("the Vulkan loader has version 1.0, not 1.1: install a newer libvulkan1".to_owned()));
    }
    let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_1);
    let mut info = vk::InstanceCreateInfo::default().application_info(&application);
    let layers = [LAYER.as_ptr()];
    let extensions = [ext::debug_utils::NAME.as_ptr(), ext::validation_features::NAME.as_ptr()];
    let mut messenger = messenger(messages);
    let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
    if validation != Validation::Off {
        // SAFETY: as above.
        let known = unsafe { entry.enumerate_instance_layer_properties() }.map_err(failed("the layers of Vulkan"))?;
        if !known.iter().any(|layer| layer.layer_name_as_c_str() == Ok(LAYER)) {
            return Err(Error(
                "the layer VK_LAYER_KHRONOS_validation is missing: install Debian's package vulkan-validationlayers"
                    .to_owned(),
            ));
        }
        info = info.enabled_layer_names(&layers).enabled_extension_names(&extensions).push_next(&mut messenger);
    }
    if validation == Validation::Synchronization {
        info = info.push_next(&mut features);
    }
    // SAFETY: the structs that `info` points to live until the end of the call.
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => no_driver(),
        other => failed("a Vulkan instance")(other),
    })
}

fn messenger(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'_> {
    use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::ERROR | Severity::WARNING)
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
        .pfn_user_callback(Some(record))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast())
}

/// Stores a message of the validation layer.
unsafe extern "system" fn record(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes a message that ends with a zero, and the address of the messages that `messenger` gave
    // it.
    let (text, messages) = unsafe { ((*data).message_as_c_str(), &*messages.cast::<Messages>()) };
    let text = text.map(CStr::to_string_lossy).unwrap_or_default().into_owned();
    messages.lock().unwrap_or_else(PoisonError::into_inner).push(text);
    vk::FALSE
}

/// Chooses a device by a part of its name, or by its type. Returns it with its name.
fn choose(instance: &ash::Instance, wanted: Option<&str>) -> Result<(vk::PhysicalDevice, String), Error> {
    // SAFETY: the instance exists.
    let devices = unsafe { instance.enumerate_physical_devices() }.map_err(failed("the devices of Vulkan"))?;
    let described = devices.into_iter().map(|device| {
        // SAFETY: the device is one of the instance.
        let properties = unsafe { instance.get_physical_device_properties(device) };
        let name = properties.device_name_as_c_str().map(CStr::to_string_lossy).unwrap_or_default().into_owned();
        (device, name, properties)
    });
    let described: Vec<_> = described.collect();
    let names: Vec<String> = described.iter().map(|(_, name, _)| format!("`{name}`")).collect();
    let matches = |name: &str| wanted.is_none_or(|wanted| name.to_lowercase().contains(&wanted.to_lowercase()));
    let rank = |properties: &vk::PhysicalDeviceProperties| match properties.device_type {
        vk::PhysicalDeviceType::DISCRETE_GPU => 0,
        vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
        vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
        _ => 3,
    };
    let chosen = described.into_iter().filter(|(_, name, _)| matches(name)).min_by_key(|(.., one)| rank(one));
    let Some((device, name, properties)) = chosen else {
        return Err(match wanted.filter(|_| !names.is_empty()) {
            Some(wanted) => Error(format!("no Vulkan device is named `{wanted}`; there are {}", names.join(", "))),
            None => no_driver(),
        });
    };
    let version = properties.api_version;
    let [major, minor] = [vk::api_version_major(version), vk::api_version_minor(version)];
    Ok((device, format!("{name}, Vulkan {major}.{minor}")))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by a panic")]

    use super::*;

    #[test]
    fn a_missing_loader_names_the_package() {
        // SAFETY: there is no such library.
        let entry = unsafe { ash::Entry::load_from("/no/such/libvulkan.so.1") };
        let error = not_loaded(&entry.err().unwrap()).to_string();
        assert!(error.contains("libvulkan1") && error.contains("/no/such/libvulkan.so.1"), "{error}");
    }

    #[test]
    fn an_unknown_device_is_an_error_that_lists_the_others() {
        let error = Context::open(&Settings { device: Some("no such device"), ..Settings::default() }).err().unwrap();
        assert!(error.to_string().contains("there are `"), "{error}");
    }
}
