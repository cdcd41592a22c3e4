//! Axis `opaque`: how opaque surfaces occlude fragments. The caller supplies their depth buffer as an external texture.

use crate::vocabulary::{
    Access, Capability, Compare, DepthState, Edit, Element, Feature, Init, Resource, Row, TextureFormat, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![none(), in_shader(), early_depth()]
}

fn none() -> Row {
    Row {
        template: Some(template!("opaque/none")),
        ..Row::new("opaque", "none", "not at all: the plan has no depth buffer of opaque surfaces", "")
    }
}

/// Tests the depth buffer in every shader of a geometry pass.
fn in_shader() -> Row {
    Row {
        template: Some(template!("opaque/in_shader")),
        resources: vec![depth_buffer()],
        uses: vec![Use::new(DEPTH_BUFFER, Access::Sampled)],
        calls: vec!["addressing"],
        ..Row::new(
            "opaque",
            "in_shader",
            "every geometry pass reads the depth buffer as a texture and rejects hidden fragments, not equal depths",
            "",
        )
    }
}

/// Tests depth before the shader runs. The depth is the rasteriser's, which a caller's shader may replace.
fn early_depth() -> Row {
    let test = DepthState { resource: DEPTH_BUFFER.to_owned(), compare: Compare::LessEqual, write: false, early: true };
    Row {
        template: Some(template!("opaque/none")),
        resources: vec![depth_buffer()],
        requires: vec![Capability::SyncInShader, Capability::CullInShader, Capability::OneSample],
        needs: vec![Feature::EarlyDepth, Feature::OwnEntryPoints],
        former_key: Some("early"),
        edits: vec![Edit::TestDepth(test)],
        ..Row::new(
            "opaque",
            "early_depth",
            "the same by a depth test before the shader; rejected fragments are not counted",
            "",
        )
    }
}

const DEPTH_BUFFER: &str = "opaque";

fn depth_buffer() -> Resource {
    let summary = "depth of the nearest opaque surface; 1: none";
    let texture = Resource::new(DEPTH_BUFFER, Element::Texture(TextureFormat::Depth32Float), summary);
    Resource { init: Init::External, ..texture.by("pixel", "pixels") }
}
