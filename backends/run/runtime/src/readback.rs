//! Readbacks of words from the device. A [`Pending`] is a future that becomes ready after the recorded commands are submitted.
//! Where blocking is possible, [`Pending::wait`] blocks.

use std::fmt;
use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};

use crate::Error;
use crate::error_scope::is_lost;
use crate::words::from_bytes;

/// A readback that has been recorded.
pub struct Pending<T> {
    buffer: wgpu::Buffer,
    state: Arc<Mutex<State>>,
    decode: Option<Decode<T>>,
}

type Decode<T> = Box<dyn FnOnce(Vec<u32>) -> T + Send>;

#[derive(Default)]
struct State {
    mapped: Option<Result<(), wgpu::BufferAsyncError>>,
    waker: Option<Waker>,
}

impl<T> Pending<T> {
    /// Records the copy of `bytes` bytes (a multiple of 4, not 0) from `offset` of `source` on, and the mapping.
    pub(crate) fn record(
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        source: &wgpu::Buffer,
        offset: u64,
        bytes: u64,
        decode: impl FnOnce(Vec<u32>) -> T + Send + 'static,
    ) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("fragbuf readback"),
            size: bytes,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let state = Arc::new(Mutex::new(State::default()));
        if is_lost(device) {
            // A copy on a lost device fails with a misleading message when it is submitted.
            lock(&state).mapped = Some(Err(wgpu::BufferAsyncError));
            return Pending { buffer, state, decode: None };
        }
        encoder.copy_buffer_to_buffer(source, offset, &buffer, 0, bytes);
        let shared = Arc::clone(&state);
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |mapped| {
            let mut state = lock(&shared);
            state.mapped = Some(mapped);
            if let Some(waker) = state.waker.take() {
                waker.wake();
            }
        });
        Pending { buffer, state, decode: Some(Box::new(decode)) }
    }

    /// Whether the words are available, so that awaiting them does not wait.
    pub fn is_ready(&self) -> bool {
        lock(&self.state).mapped.is_some()
    }

    /// Blocks until the words are available. Browsers cannot block: await the future there.
    pub fn wait(self, device: &wgpu::Device) -> Result<T, Error> {
        crate::block_on(device, self)?
    }

    fn words(&self) -> Result<Vec<u32>, Error> {
        let view = self.buffer.get_mapped_range(..).map_err(|_| Error::DeviceLost)?;
        let words = from_bytes(&view);
        drop(view);
        self.buffer.unmap();
        Ok(words)
    }
}

impl<T> fmt::Debug for Pending<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pending").field("is_ready", &self.is_ready()).finish_non_exhaustive()
    }
}

impl<T> Future for Pending<T> {
    type Output = Result<T, Error>;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let mut state = lock(&self.state);
        match state.mapped.take() {
            None => {
                state.waker = Some(context.waker().clone());
                Poll::Pending
            }
            Some(Err(_)) => Poll::Ready(Err(Error::DeviceLost)),
            Some(Ok(())) => {
                drop(state);
                let words = self.words();
                Poll::Ready(match self.decode.take() {
                    Some(decode) => words.map(decode),
                    None => Err(Error::DeviceLost),
                })
            }
        }
    }
}

/// Locks the state. A poisoned lock is accepted, because a panicking callback leaves the state complete.
fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
