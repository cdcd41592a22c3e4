//! Runs calls of wgpu in error scopes and returns their errors.
//!
//! On a lost device wgpu creates invalid objects without an error, so that their first use fails with a misleading message.
//! [`is_lost`] detects this by creating a small buffer.

use crate::Error;

/// Runs `make` in an error scope and returns its result or its error. `what` and `bytes` are for messages.
pub(crate) async fn in_error_scope<T>(
    device: &wgpu::Device,
    what: &str,
    bytes: u64,
    make: impl FnOnce() -> T,
) -> Result<T, Error> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let made = make();
    // The scopes end here, even if their errors arrive later.
    let (internal, validation, memory) = (internal.pop(), validation.pop(), memory.pop());
    let errors = [internal.await, validation.await, memory.await];
    if is_lost(device) {
        return Err(Error::DeviceLost);
    }
    let what = what.to_owned();
    match errors.into_iter().flatten().next() {
        None => Ok(made),
        Some(wgpu::Error::OutOfMemory { .. }) => Err(Error::OutOfMemory { what, bytes }),
        Some(wgpu::Error::Validation { description, .. }) => Err(Error::Validation { what, message: description }),
        Some(wgpu::Error::Internal { description, .. }) => Err(Error::Internal { what, message: description }),
    }
}

/// Whether a native device has been lost. A lost device in a browser reports no error here; its readbacks fail.
pub(crate) fn is_lost(device: &wgpu::Device) -> bool {
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let probe = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("fragbuf probe"),
        size: 4,
        // Vulkan has no buffer that can only be mapped.
        usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: true,
    });
    let lost = probe.get_mapped_range(..).is_err();
    drop(validation.pop());
    lost
}
