//! The draws of the caller's scene, for frames whose conditions the device evaluates.

use crate::Error;

/// One draw of the caller's scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneDraw {
    /// The number of its object ([`Renderer::set_objects`](crate::Renderer::set_objects)); 0 if the scene has none.
    pub object: u32,
    /// The arguments.
    pub arguments: DrawArguments,
}

/// The arguments of a draw. `first_instance` must be 0 where the device lacks `INDIRECT_FIRST_INSTANCE`.
#[derive(Clone, Copy, Debug)]
pub enum DrawArguments {
    /// Without an index buffer.
    Vertices(wgpu::util::DrawIndirectArgs),
    /// With the index buffer that the caller sets.
    Indexed(wgpu::util::DrawIndexedIndirectArgs),
}

/// The words of the arguments of a draw. Without indices it uses four.
pub(crate) const ARGUMENT_WORDS: u32 = 5;

/// Where the arguments of a pass come from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum CallArguments<'a> {
    /// From the scene's draws.
    Direct,
    /// From the device's arguments; those of the first draw are at `offset`.
    Conditional { arguments: &'a wgpu::Buffer, offset: u64 },
}

impl SceneDraw {
    /// Returns the arguments and the object.
    pub(crate) fn words(&self) -> [u32; ARGUMENT_WORDS as usize + 1] {
        match self.arguments {
            DrawArguments::Vertices(of) => {
                [of.vertex_count, of.instance_count, of.first_vertex, of.first_instance, 0, self.object]
            }
            DrawArguments::Indexed(of) => [
                of.index_count,
                of.instance_count,
                of.first_index,
                of.base_vertex.cast_unsigned(),
                of.first_instance,
                self.object,
            ],
        }
    }

    /// Records the draw.
    pub(crate) fn record(&self, pass: &mut wgpu::RenderPass<'_>, number: usize, arguments: CallArguments<'_>) {
        match (arguments, self.arguments) {
            (CallArguments::Direct, DrawArguments::Vertices(of)) => pass.draw(
                of.first_vertex..of.first_vertex.saturating_add(of.vertex_count),
                of.first_instance..of.first_instance.saturating_add(of.instance_count),
            ),
            (CallArguments::Direct, DrawArguments::Indexed(of)) => pass.draw_indexed(
                of.first_index..of.first_index.saturating_add(of.index_count),
                of.base_vertex,
                of.first_instance..of.first_instance.saturating_add(of.instance_count),
            ),
            (CallArguments::Conditional { arguments, offset }, of) => {
                let at = offset + 4 * u64::from(ARGUMENT_WORDS) * number as u64;
                match of {
                    DrawArguments::Vertices(_) => pass.draw_indirect(arguments, at),
                    DrawArguments::Indexed(_) => pass.draw_indexed_indirect(arguments, at),
                }
            }
        }
    }
}

/// Checks that indirect draws of the device can have these arguments.
pub(crate) fn check_draws(device: &wgpu::Device, draws: &[SceneDraw]) -> Result<(), Error> {
    let first_instance = |draw: &SceneDraw| match draw.arguments {
        DrawArguments::Vertices(of) => of.first_instance,
        DrawArguments::Indexed(of) => of.first_instance,
    };
    let has_feature = device.features().contains(wgpu::Features::INDIRECT_FIRST_INSTANCE);
    match draws.iter().position(|draw| first_instance(draw) != 0 && !has_feature) {
        None => Ok(()),
        Some(number) => Err(Error::BadValue {
            name: format!("the first instance of draw {number}"),
            expected: "0, or a device with `INDIRECT_FIRST_INSTANCE`".to_owned(),
        }),
    }
}
