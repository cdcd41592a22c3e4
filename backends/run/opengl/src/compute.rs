//! Runs one compute shader on words.

use glow::HasContext as _;

use crate::memory::Memory;
use crate::program::link;
use crate::{Context, Error};

impl Context {
    /// Runs a shader in `groups` workgroups. Its storage buffer 0 has the words `inputs`; returns the `results` words that it writes
    /// to storage buffer 1, which begins as zeros.
    pub fn compute(&self, source: &str, inputs: &[u32], results: usize, groups: u32) -> Result<Vec<u32>, Error> {
        let gl = &self.gl;
        let program = link(gl, &[(glow::COMPUTE_SHADER, "compute", source)])?;
        let buffers = [Memory::of_words(gl, inputs)?, Memory::of_words(gl, &vec![0; results])?];
        (0..).zip(buffers).for_each(|(binding, buffer)| buffer.bind(gl, binding));
        // SAFETY: the context is current.
        let error = unsafe {
            gl.use_program(Some(program));
            gl.dispatch_compute(groups, 1, 1);
            gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
            gl.get_error()
        };
        let words = buffers[1].words(gl, 0, u64::MAX);
        // SAFETY: the context is current.
        unsafe { gl.delete_program(program) };
        buffers.into_iter().for_each(|buffer| buffer.delete(gl));
        if error == glow::NO_ERROR { Ok(words) } else { Err(Error(format!("OpenGL reports error {error:#x}"))) }
    }
}
