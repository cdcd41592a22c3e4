//! Blocking waits, for native programs.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use crate::Error;

/// The number of polls after which a pending future counts as stuck.
const MAX_POLLS: usize = 64;

/// Runs a future of this crate to completion and waits for the device as needed. Returns [`Error::NotSubmitted`] if the future
/// waits for work that was not submitted.
pub fn block_on<T>(device: &wgpu::Device, future: impl Future<Output = T>) -> Result<T, Error> {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    for _ in 0..MAX_POLLS {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return Ok(value);
        }
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| Error::DeviceLost)?;
    }
    Err(Error::NotSubmitted)
}
