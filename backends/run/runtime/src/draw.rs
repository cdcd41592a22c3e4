//! The caller's side of a frame: the draw function, its arguments and the output.

use fragbuf_templates::vocabulary::Pass;

use crate::Error;
use crate::draws::{CallArguments, SceneDraw};

/// One draw that the caller makes.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// The pass.
    pub pass: &'a Pass,
    /// The objects to draw, by their numbers in [`Renderer::set_objects`](crate::Renderer::set_objects), in ascending order; `None`: all.
    pub objects: Option<&'a [u32]>,
    /// The draws of [`Renderer::set_draws`](crate::Renderer::set_draws).
    pub(crate) draws: &'a [SceneDraw],
    pub(crate) arguments: CallArguments<'a>,
}

impl Call<'_> {
    /// Records draw `number` of [`Renderer::set_draws`](crate::Renderer::set_draws), unless its object is not to be drawn. The caller has
    /// set its vertex and index buffers. With [`Conditions::OnDevice`](crate::Conditions::OnDevice) every draw of the scene must be
    /// recorded by this function: the device skips it once a loop is over. Fails if there is no such draw.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, number: usize) -> Result<(), Error> {
        let Some(draw) = self.draws.get(number) else {
            return Err(Error::BadValue {
                name: format!("the draw {number}"),
                expected: format!("less than {}, the number of draws of `Renderer::set_draws`", self.draws.len()),
            });
        };
        if self.objects.is_none_or(|objects| objects.binary_search(&draw.object).is_ok()) {
            draw.record(pass, number, self.arguments);
        }
        Ok(())
    }
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
