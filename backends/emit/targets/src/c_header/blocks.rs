//! Writes uniform blocks as structs whose offsets the compiler checks, and the inputs of the vertex stage.

use std::fmt::Write;

use fragbuf_codegen::Form;
use fragbuf_model::{UniformBlock, UniformType};

use super::Writer;
use super::names::{Names, string};
use crate::manifest::{CAMERA, FRAME, UNIFORMS};

/// The type of a member, and the number of elements of its array; `None`: no array.
fn c_type(kind: UniformType) -> (&'static str, Option<u32>) {
    match kind {
        UniformType::F32 => ("float", None),
        UniformType::U32 => ("uint32_t", None),
        UniformType::I32 => ("int32_t", None),
        UniformType::Vec2 => ("float", Some(2)),
        UniformType::Vec3 => ("float", Some(3)),
        UniformType::Vec4 => ("float", Some(4)),
    }
}

/// A member: its name, its type, the elements of its array, its offset.
struct Member {
    name: String,
    kind: &'static str,
    elements: Option<u32>,
    offset: u32,
}

impl Writer<'_> {
    /// Writes the uniform blocks and the vertex inputs. Returns the names and lengths of their tables.
    pub(super) fn blocks(&mut self) -> [(String, usize); 2] {
        let frame: Vec<(String, UniformType)> =
            self.plan.fields.iter().map(|id| (self.plan.symbols.get(*id).name.to_string(), UniformType::U32)).collect();
        let uniforms = &self.plan.variant.uniforms;
        let user: Vec<(String, UniformType)> =
            uniforms.iter().map(|uniform| (uniform.name.value.clone(), uniform.kind.value)).collect();
        let mut rows = vec![self.block("frame", FRAME, members(&frame))];
        if !user.is_empty() {
            rows.push(self.block("uniforms", UNIFORMS, members(&user)));
        }
        // In module form, the vertex stage is the caller's.
        if self.form == Form::Program {
            let matrix = Member { name: "view_projection".to_owned(), kind: "float", elements: Some(16), offset: 0 };
            rows.push(self.block("camera", CAMERA, (vec![matrix], 64)));
        }
        [self.table("struct fragbuf_block", "blocks", &rows), self.vertex_inputs()]
    }

    /// Writes a block, and returns its row.
    fn block(&mut self, name: &str, binding: u32, (members, size): (Vec<Member>, u32)) -> String {
        let structure = self.name(name);
        let _ = write!(self.text, "\n/* The uniform block `{name}`, binding {binding}. */\nstruct {structure} {{\n");
        let (mut names, mut end, mut asserts) = (Names::default(), 0, String::new());
        for Member { name: field, kind, elements, offset } in members {
            self.padding(&mut names, end, offset);
            let member = names.fresh(&field);
            let count = elements.map_or(String::new(), |count| format!("[{count}]"));
            let _ = writeln!(self.text, "    {kind} {member}{count};");
            let _ = writeln!(
                asserts,
                "static_assert(offsetof(struct {structure}, {member}) == {offset}, {});",
                string(&field)
            );
            end = offset + 4 * elements.unwrap_or(1);
        }
        self.padding(&mut names, end, size);
        let _ =
            write!(self.text, "}};\n{asserts}static_assert(sizeof(struct {structure}) == {size}, {});\n", string(name));
        self.constant(&format!("{name}_binding"), binding, &format!("the binding of the block `{name}`"));
        format!("{{{}, {binding}, {}, {size}}},", string(name), self.opengl_binding(binding))
    }

    /// Writes the words between the end of a member and the next offset.
    fn padding(&mut self, names: &mut Names, end: u32, offset: u32) {
        if offset > end {
            let _ =
                writeln!(self.text, "    uint32_t {}[{}];", names.fresh(&format!("padding_{end}")), (offset - end) / 4);
        }
    }

    fn vertex_inputs(&mut self) -> (String, usize) {
        if self.form != Form::Program {
            return self.table("struct fragbuf_vertex_input", "vertex_inputs", &[]);
        }
        let inputs = self.plan.variant.attributes.iter().filter(|attribute| attribute.is_vertex_input());
        let others = inputs.map(|attribute| (attribute.name.value.clone(), attribute.format.value.wgsl_type()));
        let all: Vec<(String, &str)> = std::iter::once(("position".to_owned(), "vec3<f32>")).chain(others).collect();
        self.text.push('\n');
        let mut rows = Vec::new();
        for (location, (name, kind)) in (0..).zip(&all) {
            self.constant(&format!("location_{name}"), location, &format!("the vertex input `{name}`, {kind}"));
            rows.push(format!("{{{}, {}, {location}}},", string(name), string(kind)));
        }
        self.table("struct fragbuf_vertex_input", "vertex_inputs", &rows)
    }
}

/// Returns the members of a block with their offsets, and its size.
fn members(fields: &[(String, UniformType)]) -> (Vec<Member>, u32) {
    let UniformBlock { offsets, size } = UniformBlock::of_types(fields.iter().map(|(_, kind)| *kind));
    let member = |((name, kind), offset): (&(String, UniformType), u32)| {
        let (kind, elements) = c_type(*kind);
        Member { name: name.clone(), kind, elements, offset }
    };
    (fields.iter().zip(offsets).map(member).collect(), size)
}
