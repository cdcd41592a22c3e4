//! Waiting, where a thread may: native programs only.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use crate::Error;

/// How often a future may ask for more work of the device before it counts as stuck.
const ROUNDS: usize = 64;

/// Runs a future of this crate to its end, waiting for the device whenever it must. [`Error::NotSubmitted`]: it waits
/// for work that nobody submitted.
pub fn block_on<T>(device: &wgpu::Device, future: impl Future<Output = T>) -> Result<T, Error> {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    for _ in 0..ROUNDS {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return Ok(value);
        }
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| Error::Lost)?;
    }
    Err(Error::NotSubmitted)
}
