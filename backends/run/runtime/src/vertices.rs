//! What a vertex of a geometry pass carries: the position and one input per attribute but depth.

use fragbuf_codegen::Plan;
use fragbuf_model::Format;

use crate::VertexBuffer;

/// The inputs of the vertex stage, and where each lies in one interleaved buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexInputs {
    /// In the order of their locations; the position comes first.
    pub inputs: Vec<VertexInput>,
    /// Bytes of one vertex.
    pub stride: u64,
}

/// One input of the vertex stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexInput {
    /// The attribute's name, or `position`.
    pub name: String,
    /// Its location.
    pub location: u32,
    /// What it is read as: an `rgba8` or `rgba16` attribute comes in as four floats.
    pub format: wgpu::VertexFormat,
    /// Bytes before it in an interleaved vertex.
    pub offset: u64,
}

impl VertexInputs {
    /// The inputs of a plan's geometry passes.
    pub fn of(plan: &Plan) -> Self {
        let attributes = plan.variant.attributes.iter().filter(|attribute| attribute.name.value != "depth");
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

    /// All inputs in one buffer.
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
