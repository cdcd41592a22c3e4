//! The shader interface of an entry point: its inputs and outputs.
//!
//! Input: the bindings of an entry point's arguments and result. Output: `in` and `out` declarations with explicit
//! locations, and the printed text of each argument. Stages are matched by location, so names are arbitrary: `in_` or
//! `out_` before the WGSL name.

use naga::{
    Binding, BuiltIn, EntryPoint, Expression, Function, Handle, Interpolation, Sampling, ShaderStage, Span, Type,
    TypeInner,
};

use crate::precedence::Text;
use crate::printer::Printer;

/// The printed form of an entry-point argument.
#[derive(Clone)]
pub enum Argument {
    Value(Text),
    /// A structure of which only members are used: each is a separate global.
    Members(Vec<Text>),
    /// A structure that is used as a whole: `main` assembles it under this name.
    Whole {
        name: String,
        ty: Handle<Type>,
        members: Vec<Text>,
    },
}

/// A part of the result, with the global that it is assigned to.
#[derive(Clone)]
pub struct Output {
    pub target: String,
    /// True for the sample mask, which is signed in GLSL.
    pub as_int: bool,
    pub is_position: bool,
}

/// The inputs and outputs of an entry point.
#[derive(Default)]
pub struct Interface {
    pub arguments: Vec<Argument>,
    pub outputs: Vec<Output>,
    /// Declarations at module scope.
    pub declarations: Vec<String>,
}

impl Printer<'_> {
    /// Returns the interface of an entry point.
    pub fn interface(&mut self, entry: &EntryPoint) -> Interface {
        let mut interface = Interface::default();
        for (index, argument) in entry.function.arguments.iter().enumerate() {
            let name = argument.name.as_deref().unwrap_or("argument");
            let text = match &argument.binding {
                Some(binding) => {
                    Argument::Value(self.input(entry.stage, name, argument.ty, binding, &mut interface.declarations))
                }
                None => self.input_structure(entry, index, argument.ty, name, &mut interface.declarations),
            };
            interface.arguments.push(text);
        }
        if let Some(result) = &entry.function.result {
            match &result.binding {
                Some(binding) => {
                    let name = if entry.stage == ShaderStage::Fragment { "color" } else { "value" };
                    let output = self.output(entry.stage, name, result.ty, binding, &mut interface.declarations);
                    interface.outputs.push(output);
                }
                None => self.output_structure(entry, result.ty, &mut interface),
            }
        }
        interface
    }

    /// Declares the members of a structure of inputs.
    fn input_structure(
        &mut self,
        entry: &EntryPoint,
        index: usize,
        ty: Handle<Type>,
        name: &str,
        declarations: &mut Vec<String>,
    ) -> Argument {
        let module = self.module;
        let TypeInner::Struct { ref members, .. } = module.types[ty].inner else {
            self.error("an entry point's argument without a binding", Span::UNDEFINED);
            return Argument::Members(Vec::new());
        };
        let inputs = members.iter().map(|member| {
            let member_name = member.name.as_deref().unwrap_or("member");
            match &member.binding {
                Some(binding) => self.input(entry.stage, member_name, member.ty, binding, declarations),
                None => Text::primary(self.error("an input without a binding", Span::UNDEFINED)),
            }
        });
        let inputs = inputs.collect();
        if is_used_whole(&entry.function, index) {
            return Argument::Whole { name: name.to_owned(), ty, members: inputs };
        }
        Argument::Members(inputs)
    }

    /// Declares the members of a structure of outputs.
    fn output_structure(&mut self, entry: &EntryPoint, ty: Handle<Type>, interface: &mut Interface) {
        let module = self.module;
        let TypeInner::Struct { ref members, .. } = module.types[ty].inner else {
            self.error("an entry point's result without a binding", Span::UNDEFINED);
            return;
        };
        for member in members {
            let name = member.name.as_deref().unwrap_or("member");
            let Some(binding) = &member.binding else {
                self.error("an output without a binding", Span::UNDEFINED);
                continue;
            };
            let output = self.output(entry.stage, name, member.ty, binding, &mut interface.declarations);
            interface.outputs.push(output);
        }
    }

    /// Declares an input and returns its text.
    fn input(
        &mut self,
        stage: ShaderStage,
        name: &str,
        ty: Handle<Type>,
        binding: &Binding,
        declarations: &mut Vec<String>,
    ) -> Text {
        match *binding {
            Binding::BuiltIn(builtin) => self.builtin_input(builtin, ty),
            Binding::Location { location, interpolation, sampling, .. } => {
                let qualifiers = if stage == ShaderStage::Fragment {
                    self.interpolation(interpolation, sampling)
                } else {
                    String::new()
                };
                let name = self.names.declare(&format!("in_{name}"));
                let declaration = self.declaration(ty, &name, Span::UNDEFINED);
                declarations.push(format!("layout(location = {location}) {qualifiers}in {declaration};"));
                Text::primary(name)
            }
        }
    }

    /// Declares an output.
    fn output(
        &mut self,
        stage: ShaderStage,
        name: &str,
        ty: Handle<Type>,
        binding: &Binding,
        declarations: &mut Vec<String>,
    ) -> Output {
        let plain = |target: &str| Output { target: target.to_owned(), as_int: false, is_position: false };
        match *binding {
            Binding::BuiltIn(BuiltIn::Position { invariant }) => {
                if invariant {
                    declarations.push("invariant gl_Position;".to_owned());
                }
                Output { is_position: true, ..plain("gl_Position") }
            }
            Binding::BuiltIn(BuiltIn::FragDepth) => plain("gl_FragDepth"),
            Binding::BuiltIn(BuiltIn::PointSize) => plain("gl_PointSize"),
            Binding::BuiltIn(BuiltIn::SampleMask) => {
                self.require_es_extension("GL_OES_sample_variables");
                Output { as_int: true, ..plain("gl_SampleMask[0]") }
            }
            Binding::BuiltIn(builtin) => {
                plain(&self.error(format!("the built-in output {builtin:?}"), Span::UNDEFINED))
            }
            Binding::Location { location, interpolation, sampling, blend_src, .. } => {
                let qualifiers = if stage == ShaderStage::Vertex {
                    self.interpolation(interpolation, sampling)
                } else {
                    String::new()
                };
                let index = blend_src.map(|index| format!(", index = {index}")).unwrap_or_default();
                let name = self.names.declare(&format!("out_{name}"));
                let declaration = self.declaration(ty, &name, Span::UNDEFINED);
                declarations.push(format!("layout(location = {location}{index}) {qualifiers}out {declaration};"));
                plain(&name)
            }
        }
    }

    /// Returns the interpolation qualifiers.
    fn interpolation(&mut self, interpolation: Option<Interpolation>, sampling: Option<Sampling>) -> String {
        let interpolation = match interpolation {
            Some(Interpolation::Flat) => return "flat ".to_owned(),
            Some(Interpolation::Linear) if self.es() => {
                self.error("linear interpolation", Span::UNDEFINED);
                ""
            }
            Some(Interpolation::Linear) => "noperspective ",
            Some(Interpolation::PerVertex) => {
                self.error("per-vertex interpolation", Span::UNDEFINED);
                ""
            }
            Some(Interpolation::Perspective) | None => "",
        };
        let sampling = match sampling {
            Some(Sampling::Centroid) => "centroid ",
            Some(Sampling::Sample) => {
                self.require_es_extension("GL_OES_shader_multisample_interpolation");
                "sample "
            }
            _ => "",
        };
        format!("{interpolation}{sampling}")
    }

    /// Requires an extension in ES, where OpenGL has the feature in core.
    fn require_es_extension(&mut self, extension: &'static str) {
        if self.es() {
            self.requirements.extensions.insert(extension);
        }
    }

    /// Returns the text of a built-in input, converted to its WGSL type.
    fn builtin_input(&mut self, builtin: BuiltIn, ty: Handle<Type>) -> Text {
        let vulkan = self.vulkan();
        // These are `int` in GLSL.
        let integer = match builtin {
            BuiltIn::VertexIndex => Some(if vulkan { "gl_VertexIndex" } else { "gl_VertexID" }),
            BuiltIn::InstanceIndex if vulkan => Some("gl_InstanceIndex"),
            // ES 3.1 has no first instance: it is 0.
            BuiltIn::InstanceIndex if self.es() => Some("gl_InstanceID"),
            BuiltIn::InstanceIndex => {
                // WGSL counts from the first instance of the draw, OpenGL from zero.
                self.requirements.extensions.insert("GL_ARB_shader_draw_parameters");
                Some("gl_BaseInstanceARB + gl_InstanceID")
            }
            BuiltIn::SampleIndex => {
                self.require_es_extension("GL_OES_sample_variables");
                Some("gl_SampleID")
            }
            BuiltIn::SampleMask => {
                self.require_es_extension("GL_OES_sample_variables");
                Some("gl_SampleMaskIn[0]")
            }
            BuiltIn::PrimitiveIndex => {
                self.require_es_extension("GL_EXT_geometry_shader");
                Some("gl_PrimitiveID")
            }
            _ => None,
        };
        if let Some(integer) = integer {
            let ty = self.type_name(ty, Span::UNDEFINED);
            return Text::primary(format!("{ty}({integer})"));
        }
        Text::primary(match builtin {
            // In both languages, w is the reciprocal of the clip-space w.
            BuiltIn::Position { .. } => "gl_FragCoord",
            BuiltIn::FrontFacing => "gl_FrontFacing",
            BuiltIn::GlobalInvocationId => "gl_GlobalInvocationID",
            BuiltIn::LocalInvocationId => "gl_LocalInvocationID",
            BuiltIn::LocalInvocationIndex => "gl_LocalInvocationIndex",
            BuiltIn::WorkGroupId => "gl_WorkGroupID",
            BuiltIn::NumWorkGroups => "gl_NumWorkGroups",
            other => return Text::primary(self.error(format!("the built-in input {other:?}"), Span::UNDEFINED)),
        })
    }
}

/// Tests whether an argument is used other than by its members.
fn is_used_whole(function: &Function, index: usize) -> bool {
    let arguments: Vec<Handle<Expression>> = function
        .expressions
        .iter()
        .filter(|(_, expression)| matches!(expression, Expression::FunctionArgument(argument) if *argument as usize == index))
        .map(|(handle, _)| handle)
        .collect();
    let is_argument = |handle: &Handle<Expression>| arguments.contains(handle);
    let in_expressions = function.expressions.iter().any(|(_, expression)| match expression {
        Expression::Compose { components, .. } => components.iter().any(is_argument),
        Expression::Access { base, .. } => is_argument(base),
        Expression::Select { accept, reject, .. } => is_argument(accept) || is_argument(reject),
        _ => false,
    });
    let mut in_statements = false;
    crate::footprint::visit(&function.body, &mut |statement| {
        in_statements |= match statement {
            naga::Statement::Call { arguments, .. } => arguments.iter().any(is_argument),
            naga::Statement::Store { value, .. } | naga::Statement::Return { value: Some(value) } => is_argument(value),
            _ => false,
        };
    });
    in_expressions || in_statements
}
