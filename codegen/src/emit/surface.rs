//! What a geometry pass draws, in program form: a vertex per position with one input per attribute, carried to the
//! fragment as it is. Depth is the rasteriser's, and so is what a fragment carries beside its attributes.

use std::fmt::Write;

use fragbuf_model::Format;

use super::fragment::construct;
use crate::layout::{Member, Source};
use crate::{Linking, Plan};

pub(super) fn text(plan: &Plan, linking: &Linking) -> String {
    let members = &plan.layout.members;
    let inputs: Vec<&Member> = members.iter().filter(|member| member.source == Source::Vertex).collect();
    let mut text = String::from("struct Vertex {\n    @location(0) position: vec3<f32>,\n");
    for (location, member) in (1..).zip(&inputs) {
        let _ = writeln!(text, "    @location({location}) {}: {},", input(member), member.format.wgsl_type());
    }
    text.push_str("}\n\n");
    varyings("Varyings", &inputs, members, &mut text);
    if members.iter().any(is_built_in) {
        // A vertex shader cannot give what the rasteriser finds out.
        varyings("Placed", &inputs, &[], &mut text);
    } else {
        text.push_str("alias Placed = Varyings;\n\n");
    }
    text.push_str("struct Camera {\n    view_projection: mat4x4<f32>,\n}\n\n");
    let _ = writeln!(text, "@group({}) @binding(2) var<uniform> camera: Camera;\n", linking.group);
    let position = "camera.view_projection * vec4<f32>(vertex.position, 1.0)".to_owned();
    let carried = inputs.iter().map(|member| format!("vertex.{}", input(member)));
    text.push_str("/// A vertex, where the camera sees it.\nfn vertex_placed(vertex: Vertex) -> Placed {\n");
    let _ = writeln!(text, "    return {};\n}}\n", construct("Placed", std::iter::once(position).chain(carried)));
    let fields = members.iter().map(|member| match member.source {
        Source::Depth => "varyings.position.z".to_owned(),
        Source::Vertex | Source::BuiltIn(_) => format!("varyings.{}", input(member)),
    });
    text.push_str("fn varyings_fragment(varyings: Varyings) -> Fragment {\n");
    let _ = writeln!(text, "    return {};\n}}", construct("Fragment", fields));
    text
}

/// What goes from the vertex stage to the fragment stage, and those of `members` that only the latter is given.
fn varyings(name: &str, inputs: &[&Member], members: &[Member], text: &mut String) {
    let _ = writeln!(text, "struct {name} {{\n    @builtin(position) @invariant position: vec4<f32>,");
    for (location, member) in inputs.iter().enumerate() {
        let flat = if member.format == Format::U32 { " @interpolate(flat)" } else { "" };
        let _ = writeln!(text, "    @location({location}){flat} {}: {},", input(member), member.format.wgsl_type());
    }
    for member in members {
        if let Source::BuiltIn(built_in) = &member.source {
            let _ = writeln!(text, "    @builtin({built_in}) {}: u32,", member.name);
        }
    }
    text.push_str("}\n\n");
}

fn is_built_in(member: &Member) -> bool {
    matches!(member.source, Source::BuiltIn(_))
}

/// The vertex input of a member. The name `position` is the vertex's own.
fn input(member: &Member) -> &str {
    if member.name == "position" { "position_" } else { &member.name }
}
