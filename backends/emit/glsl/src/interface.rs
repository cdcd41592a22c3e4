//! The borders of an entry point: what comes in from and goes out to the rest of the pipeline.
//!
//! In: the bindings on an entry point's arguments and result. Out: `in` and `out` declarations with explicit locations, and
//! for each argument the text it prints as. Both sides of a stage border are matched by location, so names are free: `in_`
//! or `out_` before the WGSL name.

use naga::{
    Binding, BuiltIn, EntryPoint, Expression, Function, Handle, Interpolation, Sampling, ShaderStage, Span, Type,
    TypeInner,
};

use crate::expression::Text;
use crate::function::FunctionPrinter;
use crate::printer::Printer;

/// How an argument of an entry point prints.
#[derive(Clone)]
pub enum Argument {
    Value(Text),
    /// A structure of which only members are used: each is a global of its own.
    Members(Vec<Text>),
    /// A structure that is used as a whole: `main` puts it together under this name.
    Whole {
        name: String,
        ty: Handle<Type>,
        members: Vec<Text>,
    },
}

/// A part of the result: the global it is assigned to.
#[derive(Clone)]
pub struct Output {
    target: String,
    /// The mask of samples is signed in GLSL.
    as_int: bool,
    is_position: bool,
}

#[derive(Default)]
pub struct Interface {
    pub arguments: Vec<Argument>,
    pub outputs: Vec<Output>,
    /// Declarations at module scope.
    pub declarations: Vec<String>,
}

impl Printer<'_> {
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
        let texts = members.iter().map(|member| {
            let member_name = member.name.as_deref().unwrap_or("member");
            match &member.binding {
                Some(binding) => self.input(entry.stage, member_name, member.ty, binding, declarations),
                None => Text::primary(self.error("an input without a binding", Span::UNDEFINED)),
            }
        });
        let texts = texts.collect();
        if is_used_whole(&entry.function, index) {
            return Argument::Whole { name: name.to_owned(), ty, members: texts };
        }
        Argument::Members(texts)
    }

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
                self.need_es_extension("GL_OES_sample_variables");
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
                self.need_es_extension("GL_OES_shader_multisample_interpolation");
                "sample "
            }
            _ => "",
        };
        format!("{interpolation}{sampling}")
    }

    /// What OpenGL has of itself, ES by an extension.
    fn need_es_extension(&mut self, extension: &'static str) {
        if self.es() {
            self.needs.extensions.insert(extension);
        }
    }

    fn builtin_input(&mut self, builtin: BuiltIn, ty: Handle<Type>) -> Text {
        let vulkan = self.vulkan();
        // GLSL has these as int.
        let integer = match builtin {
            BuiltIn::VertexIndex => Some(if vulkan { "gl_VertexIndex" } else { "gl_VertexID" }),
            BuiltIn::InstanceIndex if vulkan => Some("gl_InstanceIndex"),
            // ES 3.1 knows no first instance: it is 0.
            BuiltIn::InstanceIndex if self.es() => Some("gl_InstanceID"),
            BuiltIn::InstanceIndex => {
                // WGSL counts from the first instance of the draw, OpenGL from zero.
                self.needs.extensions.insert("GL_ARB_shader_draw_parameters");
                Some("gl_BaseInstanceARB + gl_InstanceID")
            }
            BuiltIn::SampleIndex => {
                self.need_es_extension("GL_OES_sample_variables");
                Some("gl_SampleID")
            }
            BuiltIn::SampleMask => {
                self.need_es_extension("GL_OES_sample_variables");
                Some("gl_SampleMaskIn[0]")
            }
            BuiltIn::PrimitiveIndex => {
                self.need_es_extension("GL_EXT_geometry_shader");
                Some("gl_PrimitiveID")
            }
            _ => None,
        };
        if let Some(integer) = integer {
            let ty = self.type_name(ty, Span::UNDEFINED);
            return Text::primary(format!("{ty}({integer})"));
        }
        Text::primary(match builtin {
            // Here as there, w is the reciprocal of the clip-space w.
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

/// Whether an argument is used otherwise than by its members.
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

impl FunctionPrinter<'_, '_> {
    /// Puts together the inputs that are used as a whole, and names those that need a conversion.
    pub fn assemble_inputs(&mut self) {
        let arguments = self.interface.as_ref().map(|interface| interface.arguments.clone()).unwrap_or_default();
        for (index, argument) in arguments.into_iter().enumerate() {
            let (name, ty, value) = match argument {
                Argument::Whole { name, ty, members } => {
                    let structure = self.printer.type_name(ty, Span::UNDEFINED);
                    let members: Vec<String> = members.into_iter().map(|member| member.text).collect();
                    (name, ty, format!("{structure}({})", members.join(", ")))
                }
                // A conversion reads better under the argument's own name.
                Argument::Value(text) if text.text.contains('(') && self.uses_argument(index) => {
                    let argument = &self.function.arguments[index];
                    (argument.name.clone().unwrap_or_default(), argument.ty, text.text)
                }
                _ => continue,
            };
            let name = self.declare(&name);
            let declaration = self.printer.declaration(ty, &name, Span::UNDEFINED);
            self.line(format!("{declaration} = {value};"));
            if let Some(slot) = self.interface.as_mut().and_then(|interface| interface.arguments.get_mut(index)) {
                *slot = Argument::Value(Text::primary(name));
            }
        }
    }

    fn uses_argument(&self, index: usize) -> bool {
        let is_argument = |expression: &Expression| matches!(expression, Expression::FunctionArgument(argument) if *argument as usize == index);
        self.function
            .expressions
            .iter()
            .any(|(handle, expression)| is_argument(expression) && self.plan.live.contains(&handle))
    }

    /// Assigns the result to the outputs.
    pub fn write_outputs(&mut self, value: Handle<Expression>) {
        let outputs = self.interface.as_ref().map(|interface| interface.outputs.clone()).unwrap_or_default();
        let parts = self.parts(value, outputs.len());
        for (output, part) in outputs.iter().zip(parts) {
            let part = if output.as_int { format!("int({part})") } else { part };
            self.line(format!("{} = {part};", output.target));
            if output.is_position && !self.printer.vulkan() {
                self.line("// OpenGL clips depth to -w..w, WGSL to 0..w.");
                self.line("gl_Position.z = 2.0 * gl_Position.z - gl_Position.w;");
            }
        }
    }

    /// The members of a result, or the result itself.
    fn parts(&mut self, value: Handle<Expression>, count: usize) -> Vec<String> {
        let function = self.function;
        let TypeInner::Struct { ref members, .. } = *self.order.inner(value) else {
            return vec![self.expression(value)];
        };
        let members = members.clone();
        if let (Expression::Compose { components, .. }, false) =
            (&function.expressions[value], self.values.contains_key(&value))
        {
            return components.iter().map(|component| self.expression(*component)).collect();
        }
        let mut text = self.expression(value);
        let is_name = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_name {
            let name = self.declare("result");
            let span = self.span(value);
            let declaration = self.printer.resolved_declaration(&self.order.info[value].ty, &name, span);
            self.line(format!("{declaration} = {text};"));
            text = name;
        }
        (0..count).map(|index| format!("{text}.{}", crate::names::field(&members, index))).collect()
    }
}
