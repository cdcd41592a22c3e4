//! The triangles of a frame.

/// Indexed triangles.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    /// Interleaved vertices, as words: the inputs of the vertex stage in the order of their locations, the position first.
    pub vertices: &'a [u32],
    /// Three per triangle.
    pub indices: &'a [u32],
}
