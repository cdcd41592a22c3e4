//! The caller's side of a frame: the draw function, its arguments and the output.

use fragbuf_templates::vocabulary::Pass;

/// One draw that the caller makes.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// The pass.
    pub pass: &'a Pass,
    /// The objects to draw, by their numbers in [`Renderer::set_objects`](crate::Renderer::set_objects); `None`: all.
    pub objects: Option<&'a [u32]>,
}

/// The view that frames are resolved into.
#[derive(Clone, Copy, Debug)]
pub struct Output<'a> {
    /// One sample per pixel, of the renderer's format and at least its size. The frame is its top left part, with premultiplied
    /// colours.
    pub view: &'a wgpu::TextureView,
    /// `Load` draws the frame over the previous content, `Clear` over this background.
    pub load: wgpu::LoadOp<wgpu::Color>,
}

/// The caller's draw function. It is called for each geometry pass of each slice. The bind group and the scissor rectangle of the
/// slice are set, and in program form the pipeline.
///
/// A closure needs the types of its parameters: `|pass: &mut wgpu::RenderPass<'_>, call: &Call<'_>| { … }`.
pub type Draw<'a> = dyn FnMut(&mut wgpu::RenderPass<'_>, &Call<'_>) + 'a;
