//! wgpu's errors as values: whatever is made inside a scope either stands or is an error.

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
    for error in [internal.await, validation.await, memory.await].into_iter().flatten() {
        return Err(match error {
            wgpu::Error::OutOfMemory { .. } => Error::OutOfMemory { what: what.to_owned(), bytes },
            wgpu::Error::Validation { description, .. } => {
                Error::Validation { what: what.to_owned(), message: description }
            }
            wgpu::Error::Internal { description, .. } => {
                Error::Internal { what: what.to_owned(), message: description }
            }
        });
    }
    Ok(made)
}
