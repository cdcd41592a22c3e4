//! A material with the attributes of a variant, and what a caller may do wrong with one.

use fragbuf_model::Variant;
use fragbuf_opengl_host::{Material, VertexInput};

/// Returns a material that stores the attributes of a vertex as they are, but with red and blue exchanged.
pub fn material(variant: &Variant, prefix: &str) -> Material {
    let mut inputs = vec![VertexInput { location: 0, name: "position".to_owned(), kind: "vec3<f32>".to_owned() }];
    let (mut declared, mut assigned, mut received, mut stored) =
        (String::new(), String::new(), String::new(), Vec::new());
    let mut location = 1;
    for attribute in &variant.attributes {
        let name = attribute.name.value.as_str();
        let kind = attribute.format.value.wgsl_type();
        if name == "depth" {
            stored.push("gl_FragCoord.z".to_owned());
            continue;
        }
        inputs.push(VertexInput { location, name: name.to_owned(), kind: kind.to_owned() });
        let ty = if kind == "u32" { "uint" } else { kind.strip_suffix("<f32>").unwrap_or("float") };
        let flat = if ty == "uint" { "flat " } else { "" };
        declared += &format!("layout(location = {location}) in {ty} vertex_{name};\n{flat}out {ty} surface_{name};\n");
        assigned += &format!("    surface_{name} = vertex_{name};\n");
        received += &format!("{flat}in {ty} surface_{name};\n");
        stored.push(if name == "color" { format!("surface_{name}.bgra") } else { format!("surface_{name}") });
        location += 1;
    }
    let fragment = format!(
        "{received}\nvoid main() {{\n    \
         {prefix}_store_fragment(gl_FragCoord.xy, {prefix}_Fragment({}));\n}}\n",
        stored.join(", ")
    );
    let vertex = format!(
        "layout(location = 0) in vec3 position;\n{declared}uniform mat4 view_projection;\n\nvoid main() {{\n{assigned}    \
         gl_Position = view_projection * vec4(position, 1.0);\n}}\n"
    );
    Material { vertex, fragment, inputs }
}
