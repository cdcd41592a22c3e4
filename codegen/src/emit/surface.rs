//! Generates the vertex interface of geometry passes in program form: one vertex input per attribute, passed to the fragment stage
//! unchanged. Depth, the side of the triangle and implicit attributes come from the rasteriser.

use std::fmt::Write;

use fragbuf_model::Format;

use super::fragment::construct;
use crate::layout::{Member, MemberSource};
use crate::{Linking, Plan};

pub(super) fn text(plan: &Plan, linking: &Linking) -> String {
    let members = &plan.layout.members;
    let inputs: Vec<&Member> = members.iter().filter(|member| member.source == MemberSource::Vertex).collect();
    let mut text = String::from("struct Vertex {\n    @location(0) position: vec3<f32>,\n");
    for (location, member) in (1..).zip(&inputs) {
        let _ = writeln!(text, "    @location({location}) {}: {},", input(member), member.format.wgsl_type());
    }
    text.push_str("}\n\n");
    varyings("FragmentInput", &inputs, members, &mut text);
    if members.iter().any(is_built_in) {
        // A vertex shader cannot output fragment built-ins.
        varyings("VertexOutput", &inputs, &[], &mut text);
    } else {
        text.push_str("alias VertexOutput = FragmentInput;\n\n");
    }
    text.push_str("struct Camera {\n    view_projection: mat4x4<f32>,\n}\n\n");
    let _ = writeln!(text, "@group({}) @binding(2) var<uniform> camera: Camera;\n", linking.group);
    let position = "camera.view_projection * vec4<f32>(vertex.position, 1.0)".to_owned();
    let attributes = inputs.iter().map(|member| format!("vertex.{}", input(member)));
    text.push_str("/// Transforms a vertex by the camera.\nfn vertex_output(vertex: Vertex) -> VertexOutput {\n");
    let _ =
        writeln!(text, "    return {};\n}}\n", construct("VertexOutput", std::iter::once(position).chain(attributes)));
    let fields = members.iter().map(|member| match member.source {
        MemberSource::Depth => "inputs.position.z".to_owned(),
        MemberSource::FrontFacing => format!("select(0u, 1u, inputs.{})", input(member)),
        MemberSource::Vertex | MemberSource::BuiltIn(_) => format!("inputs.{}", input(member)),
    });
    text.push_str("fn fragment_from_inputs(inputs: FragmentInput) -> Fragment {\n");
    let _ = writeln!(text, "    return {};\n}}", construct("Fragment", fields));
    text
}

/// Generates a struct of the interface between vertex and fragment stage, with those of `members` that are fragment built-ins.
fn varyings(name: &str, inputs: &[&Member], members: &[Member], text: &mut String) {
    let _ = writeln!(text, "struct {name} {{\n    @builtin(position) @invariant position: vec4<f32>,");
    for (location, member) in inputs.iter().enumerate() {
        let flat = if member.format == Format::U32 { " @interpolate(flat)" } else { "" };
        let _ = writeln!(text, "    @location({location}){flat} {}: {},", input(member), member.format.wgsl_type());
    }
    for member in members {
        let (built_in, kind) = match &member.source {
            MemberSource::FrontFacing => ("front_facing", "bool"),
            MemberSource::BuiltIn(built_in) => (built_in.as_str(), "u32"),
            MemberSource::Depth | MemberSource::Vertex => continue,
        };
        let _ = writeln!(text, "    @builtin({built_in}) {}: {kind},", input(member));
    }
    text.push_str("}\n\n");
}

fn is_built_in(member: &Member) -> bool {
    matches!(member.source, MemberSource::FrontFacing | MemberSource::BuiltIn(_))
}

/// Returns the shader input of a member. The name `position` is reserved for that of the vertex or pixel.
fn input(member: &Member) -> &str {
    if member.name == "position" { "position_" } else { &member.name }
}
