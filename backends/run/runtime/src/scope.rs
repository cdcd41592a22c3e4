//! wgpu's errors as values: whatever is made inside a scope either stands or is an error.
//!
//! On a lost device wgpu makes things that are not there and says nothing, so that the first use of them fails for a
//! reason that is not the reason. [`is_lost`] finds out by making something small.

use crate::Error;

/// Makes something; `what` and `bytes` are for messages.
pub(crate) async fn scoped<T>(
    device: &wgpu::Device,
    what: &str,
    bytes: u64,
    make: impl FnOnce() -> T,
) -> Result<T, Error> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let made = make();
    // Scopes end here, whenever their findings arrive.
    let (internal, validation, memory) = (internal.pop(), validation.pop(), memory.pop());
    let errors = [internal.await, validation.await, memory.await];
    if is_lost(device) {
        return Err(Error::Lost);
    }
    let what = what.to_owned();
    match errors.into_iter().flatten().next() {
        None => Ok(made),
        Some(wgpu::Error::OutOfMemory { .. }) => Err(Error::OutOfMemory { what, bytes }),
        Some(wgpu::Error::Validation { description, .. }) => Err(Error::Validation { what, message: description }),
        Some(wgpu::Error::Internal { description, .. }) => Err(Error::Internal { what, message: description }),
    }
}

/// Whether a native device has been lost. (A browser's goes on as if nothing had happened; readbacks fail there.)
pub(crate) fn is_lost(device: &wgpu::Device) -> bool {
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let probe = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("fragbuf probe"),
        size: 4,
        usage: wgpu::BufferUsages::MAP_WRITE,
        mapped_at_creation: true,
    });
    let lost = probe.get_mapped_range(..).is_err();
    drop(validation.pop());
    lost
}
