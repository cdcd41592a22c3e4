//! Copies words from the device to the host, and waits for them.

use fragbuf_follow::Error;

use super::Gpu;
use super::frame::Frame;

/// The bytes of the result of a query.
const QUERY_BYTES: u64 = 8;

impl Frame<'_, '_> {
    /// Submits what has been recorded, waits for it, and returns words of a buffer.
    pub fn read_words(&mut self, resource: &str, first: u64, count: u64) -> Result<Vec<u32>, Error> {
        let buffer = self.memory.buffer(resource)?.clone();
        let words = buffer.size() / 4;
        let count = count.min(words.saturating_sub(first));
        if count == 0 {
            return Ok(Vec::new());
        }
        let staging = staging(&self.gpu.device, 4 * count);
        self.encoder().copy_buffer_to_buffer(&buffer, 4 * first, &staging, 0, 4 * count);
        self.submit();
        let bytes = wait(self.gpu, &staging)?;
        Ok(bytes
            .chunks_exact(4)
            .map(|word| word.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte)))
            .collect())
    }

    /// Submits what has been recorded, waits for it, and returns the samples of the latest run of a pass.
    pub fn read_samples(&mut self, pass: &str) -> Result<Vec<u64>, Error> {
        let Some((set, count)) = self.queries.get(pass).cloned() else { return Ok(Vec::new()) };
        if count == 0 {
            return Ok(Vec::new());
        }
        let size = QUERY_BYTES * u64::from(count);
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let descriptor = wgpu::BufferDescriptor { label: Some("queries"), size, usage, mapped_at_creation: false };
        let resolved = self.gpu.device.create_buffer(&descriptor);
        let staging = staging(&self.gpu.device, size);
        let encoder = self.encoder();
        encoder.resolve_query_set(&set, 0..count, &resolved, 0);
        encoder.copy_buffer_to_buffer(&resolved, 0, &staging, 0, size);
        self.submit();
        let bytes = wait(self.gpu, &staging)?;
        Ok(bytes
            .chunks_exact(8)
            .map(|word| word.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte)))
            .collect())
    }
}

/// Creates a buffer that the host can read.
pub fn staging(device: &wgpu::Device, size: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    device.create_buffer(&wgpu::BufferDescriptor { label: Some("readback"), size, usage, mapped_at_creation: false })
}

/// Waits for everything that has been submitted, and returns the bytes of a buffer.
pub fn wait(gpu: &Gpu, staging: &wgpu::Buffer) -> Result<Vec<u8>, Error> {
    let failed = |problem: String| Error(format!("words of the device were not read: {problem}"));
    let (sender, receiver) = std::sync::mpsc::channel();
    staging.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        // The receiver waits below.
        let _ = sender.send(result);
    });
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(error.to_string()))?;
    let result = receiver.try_recv().map_err(|_| failed("the device did not answer".to_owned()))?;
    result.map_err(|error| failed(error.to_string()))?;
    let bytes = staging.slice(..).get_mapped_range().to_vec();
    staging.unmap();
    Ok(bytes)
}
