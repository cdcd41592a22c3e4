//! What a geometry pass draws, in program form: a vertex per position with one input per attribute, carried to the
//! fragment as it is. Depth is the rasteriser's.

use std::fmt::Write;

use fragbuf_model::{Attribute, Format, mangled};

use super::fragment::construct;
use crate::{Linking, Plan};

pub(super) fn text(plan: &Plan, linking: &Linking) -> String {
    let inputs: Vec<&Attribute> =
        plan.variant.attributes.iter().filter(|attribute| attribute.name.value != "depth").collect();
    let mut text = String::from("struct Vertex {\n    @location(0) position: vec3<f32>,\n");
    for (location, attribute) in (1..).zip(&inputs) {
        let (name, format) = (input(attribute), attribute.format.value.wgsl_type());
        let _ = writeln!(text, "    @location({location}) {name}: {format},");
    }
    text.push_str("}\n\nstruct Varyings {\n    @builtin(position) @invariant position: vec4<f32>,\n");
    for (location, attribute) in inputs.iter().enumerate() {
        let (name, format) = (input(attribute), attribute.format.value);
        let flat = if format == Format::U32 { " @interpolate(flat)" } else { "" };
        let _ = writeln!(text, "    @location({location}){flat} {name}: {},", format.wgsl_type());
    }
    text.push_str("}\n\nstruct Camera {\n    view_projection: mat4x4<f32>,\n}\n\n");
    let _ = writeln!(text, "@group({}) @binding(2) var<uniform> camera: Camera;\n", linking.group);
    let position = "camera.view_projection * vec4<f32>(vertex.position, 1.0)".to_owned();
    let carried = inputs.iter().map(|attribute| format!("vertex.{}", input(attribute)));
    text.push_str("fn vertex_varyings(vertex: Vertex) -> Varyings {\n");
    let _ = writeln!(text, "    return {};\n}}\n", construct("Varyings", std::iter::once(position).chain(carried)));
    let fields = plan.variant.attributes.iter().map(|attribute| match attribute.name.value.as_str() {
        "depth" => "varyings.position.z".to_owned(),
        _ => format!("varyings.{}", input(attribute)),
    });
    text.push_str("fn varyings_fragment(varyings: Varyings) -> Fragment {\n");
    let _ = writeln!(text, "    return {};\n}}", construct("Fragment", fields));
    text
}

/// The vertex input of an attribute. The name `position` is the vertex's own.
fn input(attribute: &Attribute) -> String {
    let name = mangled(&attribute.name.value);
    if name == "position" { "position_".to_owned() } else { name.into_owned() }
}
