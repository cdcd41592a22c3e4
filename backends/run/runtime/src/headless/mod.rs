//! A device and a target without a window, for tests, the command line and servers.

mod adapter;
mod instance;
mod interlock;
mod offscreen;

pub use adapter::{Choice, adapter, adapters};
pub use interlock::{open_device, supported_interlock};
pub use offscreen::{BLENDED, Offscreen};

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::{Error, Interlock};

/// A device that this crate opens.
pub struct Headless {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// The adapter.
    pub info: wgpu::AdapterInfo,
    /// Whether it has fragment shader interlock.
    pub interlock: Interlock,
    lost: Arc<AtomicBool>,
}

/// Features that are requested if the adapter has them: timestamps, coherent buffers, 64-bit atomics, forced early depth tests,
/// and passthrough shaders.
const OPTIONAL_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::MEMORY_DECORATION_COHERENT)
    .union(wgpu::Features::SHADER_INT64)
    .union(wgpu::Features::SHADER_EARLY_DEPTH_TEST)
    .union(wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS)
    .union(wgpu::Features::PASSTHROUGH_SHADERS);

impl Headless {
    /// Opens the chosen adapter as [`Headless::open_adapter`] does. Blocks.
    pub fn open(choice: &Choice, required: wgpu::Features) -> Result<Self, Error> {
        Headless::open_adapter(&adapter(choice)?, required)
    }

    /// Opens an adapter with all its limits and the features of `required`, and with timestamps, coherent buffers, 64-bit atomics, early
    /// depth tests, passthrough shaders and interlock if available. Blocks.
    pub fn open_adapter(adapter: &wgpu::Adapter, required: wgpu::Features) -> Result<Self, Error> {
        let missing = required - adapter.features();
        if !missing.is_empty() {
            return Err(Error::MissingFeatures(missing));
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("fragbuf headless"),
            required_features: required | (adapter.features() & OPTIONAL_FEATURES),
            required_limits: adapter.limits(),
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue, interlock) = open_device(adapter, &descriptor)?;
        let lost = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&lost);
        device.set_device_lost_callback(move |_, _| flag.store(true, Ordering::Relaxed));
        Ok(Headless { device, queue, info: adapter.get_info(), interlock, lost })
    }

    /// Whether the device has been lost.
    pub fn is_lost(&self) -> bool {
        // wgpu reports a loss at the next call, here a poll, whose own error adds nothing.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.lost.load(Ordering::Relaxed)
    }
}
