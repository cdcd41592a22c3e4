//! Prints declarations at module scope: structures, constants, buffers, textures, variables.
//!
//! Input: the items that the printed bodies use. Output: the lines of each declaration. A buffer of words is declared
//! without an instance name, so that its uses read `heads[i]`.

use naga::{
    AddressSpace, ArraySize, Constant, Expression, GlobalVariable, Handle, ImageClass, ImageDimension,
    MemoryDecorations, Span, StorageAccess, Type, TypeInner,
};

use crate::layout::{LayoutRules, layout_difference};
use crate::literal::literal;
use crate::names::{field_name, upper_camel};
use crate::precedence::{Precedence, Text};
use crate::printer::Printer;
use crate::texture::{format_name, opaque_type};

/// The largest length of an array that a constructor sets to zero; a loop sets longer ones.
const MAX_ZEROS_IN_CONSTRUCTOR: u32 = 8;

impl Printer<'_> {
    /// Prints a constant's name, or its value if GLSL cannot declare it.
    pub fn constant(&mut self, constant: Handle<Constant>) -> Text {
        let ty = self.module.constants[constant].ty;
        let concrete = !self.module.types[ty].inner.scalar().is_some_and(naga::Scalar::is_abstract);
        if let (Some(name), true) = (self.names.constants.get(&constant), concrete) {
            self.requirements.constants.insert(constant);
            return Text::primary(name.clone());
        }
        self.constant_expression(self.module.constants[constant].init)
    }

    /// Prints a constant expression.
    fn constant_expression(&mut self, expression: Handle<Expression>) -> Text {
        let module = self.module;
        let span = module.global_expressions.get_span(expression);
        match module.global_expressions[expression] {
            Expression::Literal(value) => {
                let written = span.to_range().and_then(|range| self.source.get(range)).unwrap_or_default();
                self.require_width(value.scalar());
                match literal(value, written) {
                    Some(text) => {
                        let precedence = if text.starts_with('-') { Precedence::Unary } else { Precedence::Primary };
                        Text::new(text, precedence)
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

    /// Prints a declaration such as `const uint LIMIT = 4096u;`.
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

    /// Prints a structure's definition.
    pub fn structure(&mut self, handle: Handle<Type>) -> Vec<String> {
        let name = self.names.types.get(&handle).cloned().unwrap_or_default();
        let mut lines = self.documentation(|documentation| documentation.types.get(&handle));
        lines.push(format!("struct {name} {{"));
        lines.extend(self.members(handle));
        lines.push("};".to_owned());
        lines
    }

    /// Prints the members of a structure, with their doc comments.
    fn members(&mut self, handle: Handle<Type>) -> Vec<String> {
        let module = self.module;
        let TypeInner::Struct { ref members, .. } = module.types[handle].inner else { return Vec::new() };
        let mut lines = Vec::new();
        for (index, member) in members.iter().enumerate() {
            let documentation = self.documentation(|documentation| documentation.struct_members.get(&(handle, index)));
            lines.extend(documentation.iter().map(|line| format!("    {line}")));
            let declaration = self.declaration(member.ty, &field_name(members, index), Span::UNDEFINED);
            lines.push(format!("    {declaration};"));
        }
        lines
    }

    /// Returns the doc comments of an item, as lines.
    pub fn documentation<'s>(&'s self, find: impl Fn(&'s naga::DocComments) -> Option<&'s Vec<String>>) -> Vec<String> {
        let lines = self.module.doc_comments.as_deref().and_then(find).into_iter().flatten();
        lines.flat_map(|comment| comment.lines()).map(documentation_line).collect()
    }

    /// Tests for a structure that ends in a runtime-sized array. GLSL allows it only as the members of a block.
    pub fn is_unwrapped(&self, global: Handle<GlobalVariable>) -> bool {
        let TypeInner::Struct { ref members, .. } = self.module.types[self.module.global_variables[global].ty].inner
        else {
            return false;
        };
        members.last().is_some_and(|last| {
            matches!(self.module.types[last.ty].inner, TypeInner::Array { size: ArraySize::Dynamic, .. })
        })
    }

    /// Tests for a private array that `main` sets to zero in a loop.
    pub fn is_long_private_array(&self, global: Handle<GlobalVariable>) -> bool {
        let variable = &self.module.global_variables[global];
        let private = variable.space == AddressSpace::Private && variable.init.is_none() && self.has_main;
        private && !self.is_written_first(global) && self.is_long_array(variable.ty)
    }

    /// Tests whether the options declare that a variable is written before it is read.
    fn is_written_first(&self, global: Handle<GlobalVariable>) -> bool {
        let name = self.module.global_variables[global].name.as_deref().unwrap_or_default();
        self.options.written_first.contains(&name)
    }

    /// Tests for an array that is too long for a constructor of zeros.
    pub fn is_long_array(&self, ty: Handle<Type>) -> bool {
        matches!(self.module.types[ty].inner, TypeInner::Array { size: ArraySize::Constant(size), .. } if size.get() > MAX_ZEROS_IN_CONSTRUCTOR)
    }

    /// Tests whether the options allow plain reads of an atomic.
    pub fn allows_plain_loads(&self, global: Handle<GlobalVariable>) -> bool {
        let name = self.module.global_variables[global].name.as_deref().unwrap_or_default();
        !self.vulkan() && self.options.plain_loads.contains(&name)
    }

    /// Prints a global variable's declaration.
    pub fn global_declaration(&mut self, handle: Handle<GlobalVariable>) -> Vec<String> {
        let variable = &self.module.global_variables[handle];
        let span = self.module.global_variables.get_span(handle);
        let name = self.names.globals.get(&handle).cloned().unwrap_or_default();
        let mut lines = self.documentation(|documentation| documentation.global_variables.get(&handle));
        match variable.space {
            AddressSpace::Storage { access } => {
                let qualifiers = self.buffer_qualifiers(handle, access);
                lines.extend(self.block(handle, &name, LayoutRules::Std430, &format!("{qualifiers}buffer"), "Buffer"));
            }
            AddressSpace::Uniform => lines.extend(self.block(handle, &name, LayoutRules::Std140, "uniform", "Block")),
            AddressSpace::Private => {
                let declaration = self.declaration(variable.ty, &name, span);
                let value = match variable.init {
                    Some(init) => format!(" = {}", self.constant_expression(init).text),
                    // `main` sets it to zero in a loop, or the shader writes it first.
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

    /// Prints the layout qualifiers for the binding of a resource.
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

    /// Returns the memory qualifiers of a buffer. `coherent` makes other invocations' writes visible to plain reads; buffers
    /// with atomics are shared, so they always have it. `volatile` also forbids the reuse of an earlier value, so that a
    /// plain read that replaces an atomic load accesses memory each time.
    fn buffer_qualifiers(&self, handle: Handle<GlobalVariable>, access: StorageAccess) -> String {
        let variable = &self.module.global_variables[handle];
        let plain = self.allows_plain_loads(handle);
        let coherent = plain
            || variable.memory_decorations.contains(MemoryDecorations::COHERENT)
            || self.contains_atomics(variable.ty);
        let volatile = plain || variable.memory_decorations.contains(MemoryDecorations::VOLATILE);
        let readonly = !access.intersects(StorageAccess::STORE | StorageAccess::ATOMIC);
        let qualifiers = [(readonly, "readonly "), (coherent, "coherent "), (volatile, "volatile ")];
        qualifiers.iter().filter(|(present, _)| *present).map(|(_, text)| *text).collect()
    }

    /// Tests whether a type contains atomics.
    fn contains_atomics(&self, ty: Handle<Type>) -> bool {
        match self.module.types[ty].inner {
            TypeInner::Atomic(_) => true,
            TypeInner::Array { base, .. } => self.contains_atomics(base),
            TypeInner::Struct { ref members, .. } => members.iter().any(|member| self.contains_atomics(member.ty)),
            _ => false,
        }
    }

    /// Prints a buffer or uniform block.
    fn block(
        &mut self,
        handle: Handle<GlobalVariable>,
        name: &str,
        rules: LayoutRules,
        keywords: &str,
        suffix: &str,
    ) -> Vec<String> {
        let ty = self.module.global_variables[handle].ty;
        let span = self.module.global_variables.get_span(handle);
        if let Some(difference) = layout_difference(self.module, ty, rules) {
            self.error(format!("the layout of `{name}`: {difference}"), span);
        }
        let standard = if rules == LayoutRules::Std430 { "std430" } else { "std140" };
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

    /// Prints the declaration of a texture or sampler.
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
                return vec![self.error("a one-dimensional texture or a cube array texture", span)];
            }
            TypeInner::Image { class: ImageClass::External, .. } => {
                return vec![self.error("an external texture", span)];
            }
            TypeInner::Image { dim, arrayed, class } if self.vulkan() => opaque_type("texture", dim, arrayed, class),
            TypeInner::Image { dim, arrayed, class } => {
                let compares = self.requirements.combined.get(&handle).is_some_and(|(_, comparison)| *comparison);
                opaque_type("sampler", dim, arrayed, class) + if compares { "Shadow" } else { "" }
            }
            TypeInner::Sampler { comparison } => if comparison { "samplerShadow" } else { "sampler" }.to_owned(),
            _ => return vec![self.error("a resource of this type", span)],
        };
        let slot = self.slot(handle);
        // Most sampler types have no default precision in ES.
        let precision = if self.es() { "highp " } else { "" };
        vec![format!("layout({slot}) uniform {precision}{ty} {name};")]
    }
}

/// Converts a line of any doc comment to a `///` line.
fn documentation_line(line: &str) -> String {
    let text = line.trim().trim_start_matches("/**").trim_end_matches("*/");
    let text = text.trim_start_matches(['/', '*', '!']).trim_end();
    format!("///{}{text}", if text.is_empty() || text.starts_with(' ') { "" } else { " " })
}
