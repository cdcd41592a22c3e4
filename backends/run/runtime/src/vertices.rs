//! The vertex of a geometry pass: the position, and one input per attribute that the rasteriser does not provide.

use fragbuf_codegen::Plan;
use fragbuf_model::Format;

use crate::VertexBuffer;

/// The inputs of the vertex stage, and their offsets in one interleaved buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexInputs {
    /// The inputs in the order of their locations; the position is the first.
    pub inputs: Vec<VertexInput>,
    /// The bytes of one vertex.
    pub stride: u64,
}

/// One input of the vertex stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexInput {
    /// The attribute's name, or `position`.
    pub name: String,
    /// Its location.
    pub location: u32,
    /// The format in the buffer: an `rgba8` or `rgba16` attribute is four floats.
    pub format: wgpu::VertexFormat,
    /// Its offset in an interleaved vertex, in bytes.
    pub offset: u64,
}

impl VertexInputs {
    /// Returns the inputs of a plan's geometry passes.
    pub fn of(plan: &Plan) -> Self {
        let attributes = plan.variant.attributes.iter().filter(|attribute| attribute.is_vertex_input());
        let attributes =
            attributes.map(|attribute| (attribute.name.value.as_str(), vertex_format(attribute.format.value)));
        let mut stride = 0;
        let mut inputs = Vec::new();
        for (name, format) in std::iter::once(("position", wgpu::VertexFormat::Float32x3)).chain(attributes) {
            inputs.push(VertexInput { name: name.to_owned(), location: inputs.len() as u32, format, offset: stride });
            stride += format.size();
        }
        VertexInputs { inputs, stride }
    }

    /// Returns the layout of one buffer with all inputs.
    pub fn interleaved(&self) -> VertexBuffer {
        let attributes = self.inputs.iter().map(|input| wgpu::VertexAttribute {
            format: input.format,
            offset: input.offset,
            shader_location: input.location,
        });
        let step_mode = wgpu::VertexStepMode::Vertex;
        VertexBuffer { stride: self.stride, step_mode, attributes: attributes.collect() }
    }
}

fn vertex_format(format: Format) -> wgpu::VertexFormat {
    match format {
        Format::F32 => wgpu::VertexFormat::Float32,
        Format::U32 => wgpu::VertexFormat::Uint32,
        Format::Vec2 => wgpu::VertexFormat::Float32x2,
        Format::Vec3 | Format::Octahedral => wgpu::VertexFormat::Float32x3,
        Format::Vec4 | Format::Rgba8 | Format::Rgba16 => wgpu::VertexFormat::Float32x4,
    }
}
