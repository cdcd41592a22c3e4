//! Axis `opaque`: what becomes of fragments behind opaque surfaces, whose depth buffer the caller brings.

use crate::vocabulary::{
    Access, Capability, Compare, DepthState, Edit, Element, Fact, Init, Resource, Row, TextureFormat, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![none(), in_shader(), early()]
}

fn none() -> Row {
    Row {
        template: Some(template!("opaque/none")),
        ..Row::new("opaque", "none", "nothing: no depth buffer of opaque surfaces is asked for", "")
    }
}

/// By every shader that takes fragments in.
fn in_shader() -> Row {
    Row {
        template: Some(template!("opaque/in_shader")),
        resources: vec![depth_buffer()],
        uses: vec![Use::new(DEPTH_BUFFER, Access::Sampled)],
        calls: vec!["addressing"],
        ..Row::new(
            "opaque",
            "in_shader",
            "they are turned away in every geometry pass, by the depth buffer as a texture; equal depths stay",
            "",
        )
    }
}

/// By a depth test, before the shader runs. Depth is the rasteriser's, which a caller's own shader may replace.
fn early() -> Row {
    let test = DepthState { resource: DEPTH_BUFFER.to_owned(), compare: Compare::LessEqual, write: false, early: true };
    Row {
        template: Some(template!("opaque/none")),
        resources: vec![depth_buffer()],
        requires: vec![Fact::LeftToShaders, Fact::CullInShader, Fact::OneSample],
        needs: vec![Capability::EarlyDepth, Capability::OwnEntryPoints],
        edits: vec![Edit::TestDepth(test)],
        ..Row::new(
            "opaque",
            "early",
            "the same by a depth test before the shader, which counts nothing of what it turns away",
            "",
        )
    }
}

const DEPTH_BUFFER: &str = "opaque";

fn depth_buffer() -> Resource {
    let summary = "depth of the nearest opaque surface; 1: none";
    let texture = Resource::new(DEPTH_BUFFER, Element::Texture(TextureFormat::Depth32Float), summary);
    Resource { init: Init::Host, ..texture.by("pixel", "pixels") }
}
