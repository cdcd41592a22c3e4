//! Declarations at module scope: structures, constants, buffers, textures, variables.
//!
//! In: what the bodies turned out to need. Out: the text of each declaration. A buffer of words is declared without an
//! instance name, so that its uses read `heads[i]`.

use naga::{
    AddressSpace, ArraySize, Constant, Expression, GlobalVariable, Handle, ImageClass, ImageDimension,
    MemoryDecorations, Span, StorageAccess, Type, TypeInner,
};

use crate::expression::{Level, Text};
use crate::layout::{Rules, disagreement};
use crate::literal::literal;
use crate::names::{field, upper_camel};
use crate::printer::Printer;
use crate::texture::{format_name, opaque_type};

/// Arrays up to this length get their zeros in a constructor; longer ones in a loop.
const ZEROS_IN_A_ROW: u32 = 8;

impl Printer<'_> {
    /// A constant's name, or its value if it has none that GLSL could declare.
    pub fn constant(&mut self, constant: Handle<Constant>) -> Text {
        let ty = self.module.constants[constant].ty;
        let concrete = !self.module.types[ty].inner.scalar().is_some_and(naga::Scalar::is_abstract);
        if let (Some(name), true) = (self.names.constants.get(&constant), concrete) {
            self.needs.constants.insert(constant);
            return Text::primary(name.clone());
        }
        self.constant_expression(self.module.constants[constant].init)
    }

    fn constant_expression(&mut self, expression: Handle<Expression>) -> Text {
        let module = self.module;
        let span = module.global_expressions.get_span(expression);
        match module.global_expressions[expression] {
            Expression::Literal(value) => {
                let written = span.to_range().and_then(|range| self.source.get(range)).unwrap_or_default();
                self.need_width(value.scalar());
                match literal(value, written) {
                    Some(text) => {
                        let level = if text.starts_with('-') { Level::Unary } else { Level::Primary };
                        Text::new(text, level)
                    }
                    None => Text::primary(self.error(crate::types::unsupported_scalar(value.scalar()), span)),
                }
            }
            Expression::Constant(constant) => self.constant(constant),
            Expression::ZeroValue(ty) => Text::primary(self.zero(ty, span)),
            Expression::Compose { ty, ref components } => {
                let name = self.type_name(ty, span);
                let parts: Vec<String> = components.iter().map(|part| self.constant_expression(*part).text).collect();
                Text::primary(format!("{name}({})", parts.join(", ")))
            }
            Expression::Splat { value, .. } => {
                let resolution = &self.info[expression];
                let name = self.resolved_name(resolution, span);
                let value = self.constant_expression(value).text;
                Text::primary(format!("{name}({value})"))
            }
            _ => Text::primary(self.error("a constant that is not a plain value", span)),
        }
    }

    /// `const uint LIMIT = 4096u;`
    pub fn constant_declaration(&mut self, handle: Handle<Constant>) -> Vec<String> {
        let span = self.module.constants.get_span(handle);
        let constant = &self.module.constants[handle];
        let name = self.names.constants.get(&handle).cloned().unwrap_or_default();
        let declaration = self.declaration(constant.ty, &name, span);
        let value = self.constant_expression(constant.init).text;
        let mut lines = self.documentation(|documentation| documentation.constants.get(&handle));
        lines.push(format!("const {declaration} = {value};"));
        lines
    }

    /// A structure's definition.
    pub fn structure(&mut self, handle: Handle<Type>) -> Vec<String> {
        let name = self.names.types.get(&handle).cloned().unwrap_or_default();
        let mut lines = self.documentation(|documentation| documentation.types.get(&handle));
        lines.push(format!("struct {name} {{"));
        lines.extend(self.members(handle));
        lines.push("};".to_owned());
        lines
    }

    fn members(&mut self, handle: Handle<Type>) -> Vec<String> {
        let module = self.module;
        let TypeInner::Struct { ref members, .. } = module.types[handle].inner else { return Vec::new() };
        let mut lines = Vec::new();
        for (index, member) in members.iter().enumerate() {
            let documentation = self.documentation(|documentation| documentation.struct_members.get(&(handle, index)));
            lines.extend(documentation.iter().map(|line| format!("    {line}")));
            let declaration = self.declaration(member.ty, &field(members, index), Span::UNDEFINED);
            lines.push(format!("    {declaration};"));
        }
        lines
    }

    /// Doc comments of an item, as lines.
    pub fn documentation<'s>(&'s self, find: impl Fn(&'s naga::DocComments) -> Option<&'s Vec<String>>) -> Vec<String> {
        let lines = self.module.doc_comments.as_deref().and_then(find).into_iter().flatten();
        lines.flat_map(|comment| comment.lines()).map(documentation_line).collect()
    }

    /// A structure that ends in an array without a length: GLSL has that as a block's members only.
    pub fn is_unwrapped(&self, global: Handle<GlobalVariable>) -> bool {
        let TypeInner::Struct { ref members, .. } = self.module.types[self.module.global_variables[global].ty].inner
        else {
            return false;
        };
        members.last().is_some_and(|last| {
            matches!(self.module.types[last.ty].inner, TypeInner::Array { size: ArraySize::Dynamic, .. })
        })
    }

    /// A private array that is too long for its zeros to be written out, in a text that has a `main` to set them.
    pub fn is_long_private_array(&self, global: Handle<GlobalVariable>) -> bool {
        let variable = &self.module.global_variables[global];
        let private = variable.space == AddressSpace::Private && variable.init.is_none() && self.has_main;
        private && !self.is_written_first(global) && self.is_long_array(variable.ty)
    }

    /// Whether no read sees the variable's initial value, by the options.
    fn is_written_first(&self, global: Handle<GlobalVariable>) -> bool {
        let name = self.module.global_variables[global].name.as_deref().unwrap_or_default();
        self.options.written_first.contains(&name)
    }

    /// Longer than reads well as a row of zeros.
    pub fn is_long_array(&self, ty: Handle<Type>) -> bool {
        matches!(self.module.types[ty].inner, TypeInner::Array { size: ArraySize::Constant(size), .. } if size.get() > ZEROS_IN_A_ROW)
    }

    /// Whether the options allow plain reads of this atomic.
    pub fn is_plain(&self, global: Handle<GlobalVariable>) -> bool {
        let name = self.module.global_variables[global].name.as_deref().unwrap_or_default();
        !self.vulkan() && self.options.plain_loads.contains(&name)
    }

    /// A global variable's declaration.
    pub fn global_declaration(&mut self, handle: Handle<GlobalVariable>) -> Vec<String> {
        let variable = &self.module.global_variables[handle];
        let span = self.module.global_variables.get_span(handle);
        let name = self.names.globals.get(&handle).cloned().unwrap_or_default();
        let mut lines = self.documentation(|documentation| documentation.global_variables.get(&handle));
        match variable.space {
            AddressSpace::Storage { access } => {
                let qualifiers = self.buffer_qualifiers(handle, access);
                lines.extend(self.block(handle, &name, Rules::Std430, &format!("{qualifiers}buffer"), "Buffer"));
            }
            AddressSpace::Uniform => lines.extend(self.block(handle, &name, Rules::Std140, "uniform", "Block")),
            AddressSpace::Private => {
                let declaration = self.declaration(variable.ty, &name, span);
                let value = match variable.init {
                    Some(init) => format!(" = {}", self.constant_expression(init).text),
                    // `main` begins by setting it to zero, in a loop.
                    None if self.is_long_private_array(handle) || self.is_written_first(handle) => String::new(),
                    None => format!(" = {}", self.zero(variable.ty, span)),
                };
                lines.push(format!("{declaration}{value};"));
            }
            AddressSpace::WorkGroup if !self.has_main => {
                drop(self.error("a workgroup variable in a library, where nothing sets it to zero", span));
            }
            AddressSpace::WorkGroup => {
                let declaration = self.declaration(variable.ty, &name, span);
                lines.push(format!("shared {declaration};"));
            }
            AddressSpace::Handle => lines.extend(self.opaque(handle, &name)),
            _ => drop(self.error(format!("a variable in the address space {:?}", variable.space), span)),
        }
        lines
    }

    fn slot(&mut self, handle: Handle<GlobalVariable>) -> String {
        let Some(binding) = self.module.global_variables[handle].binding else {
            return self.error("a resource without a binding", self.module.global_variables.get_span(handle));
        };
        let slot = (self.options.bindings)(binding.group, binding.binding);
        if self.vulkan() {
            format!("set = {}, binding = {}", slot.set, slot.binding)
        } else {
            format!("binding = {}", slot.binding)
        }
    }

    /// `coherent` makes what other invocations have written visible to this one's plain reads; words that are written by
    /// atomics are shared by nature, so they always have it. `volatile` moreover forbids to reuse a value read before,
    /// which is what makes a plain read in place of an atomic load look at memory each time.
    fn buffer_qualifiers(&self, handle: Handle<GlobalVariable>, access: StorageAccess) -> String {
        let variable = &self.module.global_variables[handle];
        let plain = self.is_plain(handle);
        let coherent = plain
            || variable.memory_decorations.contains(MemoryDecorations::COHERENT)
            || self.holds_atomics(variable.ty);
        let volatile = plain || variable.memory_decorations.contains(MemoryDecorations::VOLATILE);
        let readonly = !access.intersects(StorageAccess::STORE | StorageAccess::ATOMIC);
        let qualifiers = [(readonly, "readonly "), (coherent, "coherent "), (volatile, "volatile ")];
        qualifiers.iter().filter(|(present, _)| *present).map(|(_, text)| *text).collect()
    }

    fn holds_atomics(&self, ty: Handle<Type>) -> bool {
        match self.module.types[ty].inner {
            TypeInner::Atomic(_) => true,
            TypeInner::Array { base, .. } => self.holds_atomics(base),
            TypeInner::Struct { ref members, .. } => members.iter().any(|member| self.holds_atomics(member.ty)),
            _ => false,
        }
    }

    fn block(
        &mut self,
        handle: Handle<GlobalVariable>,
        name: &str,
        rules: Rules,
        keywords: &str,
        suffix: &str,
    ) -> Vec<String> {
        let ty = self.module.global_variables[handle].ty;
        let span = self.module.global_variables.get_span(handle);
        if let Some(difference) = disagreement(self.module, ty, rules) {
            self.error(format!("the layout of `{name}`: {difference}"), span);
        }
        let standard = if rules == Rules::Std430 { "std430" } else { "std140" };
        let slot = self.slot(handle);
        let block = self.names.declare(&(upper_camel(name) + suffix));
        let mut lines = vec![format!("layout({standard}, {slot}) {keywords} {block} {{")];
        if self.is_unwrapped(handle) {
            lines.extend(self.members(ty));
            lines.push(format!("}} {name};"));
            return lines;
        }
        let declaration = self.declaration(ty, name, span);
        lines.push(format!("    {declaration};"));
        lines.push("};".to_owned());
        lines
    }

    fn opaque(&mut self, handle: Handle<GlobalVariable>, name: &str) -> Vec<String> {
        let span = self.module.global_variables.get_span(handle);
        let ty = match self.module.types[self.module.global_variables[handle].ty].inner {
            TypeInner::Image { dim, arrayed, class: class @ ImageClass::Storage { format, access } } => {
                let Some(format) = format_name(format) else {
                    return vec![self.error("a storage texture of this format", span)];
                };
                let image = opaque_type("image", dim, arrayed, class);
                let access = match (access.contains(StorageAccess::LOAD), access.contains(StorageAccess::STORE)) {
                    (true, false) => "readonly ",
                    (false, true) => "writeonly ",
                    _ => "",
                };
                let slot = self.slot(handle);
                let precision = if self.es() { "highp " } else { "" };
                return vec![format!("layout({format}, {slot}) {access}uniform {precision}{image} {name};")];
            }
            TypeInner::Image { dim, arrayed, .. }
                if self.es() && (dim == ImageDimension::D1 || (dim == ImageDimension::Cube && arrayed)) =>
            {
                return vec![self.error("a texture of one dimension, or of several cubes", span)];
            }
            TypeInner::Image { class: ImageClass::External, .. } => {
                return vec![self.error("an external texture", span)];
            }
            TypeInner::Image { dim, arrayed, class } if self.vulkan() => opaque_type("texture", dim, arrayed, class),
            TypeInner::Image { dim, arrayed, class } => {
                let compares = self.needs.combined.get(&handle).is_some_and(|(_, comparison)| *comparison);
                opaque_type("sampler", dim, arrayed, class) + if compares { "Shadow" } else { "" }
            }
            TypeInner::Sampler { comparison } => if comparison { "samplerShadow" } else { "sampler" }.to_owned(),
            _ => return vec![self.error("a resource of this type", span)],
        };
        let slot = self.slot(handle);
        // Most kinds of samplers have no precision of their own in ES.
        let precision = if self.es() { "highp " } else { "" };
        vec![format!("layout({slot}) uniform {precision}{ty} {name};")]
    }
}

/// Doc comments as `///` lines, whichever marks they came with.
fn documentation_line(line: &str) -> String {
    let text = line.trim().trim_start_matches("/**").trim_end_matches("*/");
    let text = text.trim_start_matches(['/', '*', '!']).trim_end();
    format!("///{}{text}", if text.is_empty() || text.starts_with(' ') { "" } else { " " })
}
