//! A device and a target without a window: for tests, the command line, and pictures on a server.

mod adapter;
mod interlock;
mod offscreen;

pub use adapter::{Choice, adapters};
pub use interlock::open_device;
pub use offscreen::{BLENDED, Offscreen};

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::{Error, Interlock};

/// A device of our own.
pub struct Headless {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// What it is.
    pub info: wgpu::AdapterInfo,
    /// Whether it has fragment shader interlock.
    pub interlock: Interlock,
    lost: Arc<AtomicBool>,
}

/// Features that are requested wherever there are: timing, coherent buffers, 64-bit atomics, forced early depth tests, and
/// code that is passed through.
const WELCOME: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::MEMORY_DECORATION_COHERENT)
    .union(wgpu::Features::SHADER_INT64)
    .union(wgpu::Features::SHADER_EARLY_DEPTH_TEST)
    .union(wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS)
    .union(wgpu::Features::PASSTHROUGH_SHADERS);

impl Headless {
    /// Opens the chosen adapter with all its limits, the features of `required`, and those of timing, coherent buffers,
    /// passed-through code and interlock where there are any. Blocks.
    pub fn open(choice: &Choice, required: wgpu::Features) -> Result<Self, Error> {
        let adapter = adapter::choose(choice)?;
        let missing = required - adapter.features();
        if !missing.is_empty() {
            return Err(Error::MissingFeatures(missing));
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("fragbuf headless"),
            required_features: required | (adapter.features() & WELCOME),
            required_limits: adapter.limits(),
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue, interlock) = open_device(&adapter, &descriptor)?;
        let lost = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&lost);
        device.set_device_lost_callback(move |_, _| flag.store(true, Ordering::Relaxed));
        Ok(Headless { device, queue, info: adapter.get_info(), interlock, lost })
    }

    /// Whether the device has been lost.
    pub fn is_lost(&self) -> bool {
        // The loss is told to whoever asks the device next; that it is lost is then no news.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.lost.load(Ordering::Relaxed)
    }
}
