//! Generates the bindings and accessors of buffers. Only this file computes the index, access and size of an element; templates never
//! index a buffer.

use std::fmt::Write;

use fragbuf_model::mangled;
use fragbuf_templates::vocabulary::{Access, Element, Pass, Resource, Use};

use crate::{Linking, Plan, PlanValue, PlannedResource, Profile, SymbolId, Term, is_boolean};

pub(super) fn text(plan: &Plan, pass: &Pass, linking: &Linking, called: &[String]) -> String {
    let mut text = uniform_blocks(plan, linking);
    for planned in &plan.resources {
        let usage = pass.uses.iter().find(|usage| usage.resource == planned.resource.name);
        if let Some(usage) = usage.filter(|usage| is_buffer(&planned.resource, usage)) {
            let access = shader_access(usage.access, linking.profile);
            Accessors { plan, planned, access, called }.write(linking, &mut text);
        }
    }
    text
}

/// Returns the signatures of all accessors that a buffer has with this access: `slots_load(slot: u32, pixel: u32) -> Packed`.
pub(super) fn signatures(plan: &Plan, planned: &PlannedResource, access: Access) -> Vec<String> {
    let name = &planned.resource.name;
    let atomics = OPERATIONS.iter().map(|(operation, _)| format!("{name}_atomic_{operation}"));
    let others = ["atomic_compare_exchange"]
        .into_iter()
        .chain(if access == Access::Hinted { &["hint", "publish"][..] } else { &[] }.iter().copied());
    let called: Vec<String> = atomics.chain(others.map(|operation| format!("{name}_{operation}"))).collect();
    // Coherent words are atomic in some targets only: a template cannot use that.
    let access = shader_access(access, Profile::Native);
    let mut text = String::new();
    Accessors { plan, planned, access, called: &called }.accessors(&mut text);
    let signature = |line: &str| Some(line.strip_prefix("fn ")?.strip_suffix(" {")?.to_owned());
    text.lines().filter_map(signature).collect()
}

fn is_buffer(resource: &Resource, usage: &Use) -> bool {
    let in_shader = !matches!(usage.access, Access::Attachment | Access::Sampled | Access::Indirect);
    in_shader && !matches!(resource.element, Element::Texture(_) | Element::Texels(_))
}

fn uniform_blocks(plan: &Plan, linking: &Linking) -> String {
    let mut text = String::from("/// The size of the frame and other values that the host sets.\nstruct Frame {\n");
    for field in &plan.fields {
        let _ = writeln!(text, "    {}: u32,", plan.symbols.get(*field).name);
    }
    let _ = writeln!(text, "}}\n\n@group({}) @binding(0) var<uniform> frame: Frame;\n", linking.group);
    if !plan.variant.uniforms.is_empty() {
        text.push_str("/// The uniforms of the description.\nstruct Uniforms {\n");
        for uniform in &plan.variant.uniforms {
            let _ = writeln!(text, "    {}: {},", mangled(&uniform.name.value), uniform.kind.value.wgsl_type());
        }
        let _ = writeln!(text, "}}\n\n@group({}) @binding(1) var<uniform> uniforms: Uniforms;\n", linking.group);
    }
    text
}

/// The access of a shader to a buffer.
#[derive(Clone, Copy, PartialEq)]
enum ShaderAccess {
    Read,
    Plain,
    Coherent,
    Atomic,
    /// Atomic words of a coherent buffer. Targets may print loads and stores as plain accesses.
    CoherentAtomic,
}

/// Returns the access in shaders. Coherent words are atomic if the profile has no coherent buffers.
fn shader_access(access: Access, profile: Profile) -> ShaderAccess {
    match (access, profile) {
        (Access::Plain, _) => ShaderAccess::Plain,
        (Access::Atomic, _) | (Access::Coherent | Access::Hinted, Profile::Portable) => ShaderAccess::Atomic,
        (Access::Hinted, Profile::Native) => ShaderAccess::CoherentAtomic,
        (Access::Coherent, Profile::Native) => ShaderAccess::Coherent,
        _ => ShaderAccess::Read,
    }
}

/// The accessors of one buffer.
struct Accessors<'a> {
    plan: &'a Plan,
    planned: &'a PlannedResource,
    access: ShaderAccess,
    /// The accessors other than loads and stores that templates call.
    called: &'a [String],
}

/// Atomic operations that return the old value.
const OPERATIONS: [(&str, &str); 7] = [
    ("add", "atomicAdd"),
    ("sub", "atomicSub"),
    ("min", "atomicMin"),
    ("max", "atomicMax"),
    ("or", "atomicOr"),
    ("and", "atomicAnd"),
    ("exchange", "atomicExchange"),
];

impl Accessors<'_> {
    fn write(&self, linking: &Linking, text: &mut String) {
        if self.plan.is_declared(self.planned) {
            self.declare(linking, text);
        }
        self.accessors(text);
    }

    fn accessors(&self, text: &mut String) {
        self.load(text);
        if self.access != ShaderAccess::Read {
            self.store(text);
        }
        if self.scalar().is_some() {
            self.outside(text);
            if self.is_atomic() {
                self.atomics(text);
            }
        }
    }

    fn name(&self) -> &str {
        &self.planned.resource.name
    }

    /// Returns the words of an element.
    fn words(&self) -> u64 {
        match self.planned.resource.element {
            Element::Entry => self.plan.layout.entry_words().into(),
            Element::Value => self.plan.layout.value_words().into(),
            _ => 1,
        }
    }

    /// Returns the type of an element that is a number, or `None` for a fragment.
    fn scalar(&self) -> Option<&'static str> {
        match self.planned.resource.element {
            Element::Word => Some("u32"),
            Element::Word64 => Some("u64"),
            _ => None,
        }
    }

    fn is_atomic(&self) -> bool {
        matches!(self.access, ShaderAccess::Atomic | ShaderAccess::CoherentAtomic)
    }

    fn is_single_word(&self) -> bool {
        self.planned.resource.extents.is_empty() && self.scalar().is_some()
    }

    fn declare(&self, linking: &Linking, text: &mut String) {
        let (mode, coherent) = match self.access {
            ShaderAccess::Read => ("read", ""),
            ShaderAccess::Plain | ShaderAccess::Atomic => ("read_write", ""),
            ShaderAccess::Coherent | ShaderAccess::CoherentAtomic => ("read_write", " @coherent"),
        };
        let scalar = self.scalar().unwrap_or("u32");
        let word = if self.is_atomic() { format!("atomic<{scalar}>") } else { scalar.to_owned() };
        let kind = if self.is_single_word() { word } else { format!("array<{word}>") };
        let (summary, group, binding) = (&self.planned.resource.summary, linking.group, self.planned.binding);
        let name = self.name();
        let _ = writeln!(text, "/// {}.", capitalised(summary));
        let _ = writeln!(text, "@group({group}) @binding({binding}){coherent} var<storage, {mode}> {name}: {kind};\n");
    }

    fn load(&self, text: &mut String) {
        let name = self.name();
        let is_value = self.planned.resource.element == Element::Value;
        let parameters = self.parameters(if is_value { &["key: u32"] } else { &[] });
        if let Some(scalar) = self.scalar() {
            let read = self.read(&self.reference(None));
            let _ = writeln!(text, "fn {name}_load({parameters}) -> {scalar} {{\n    return {read};\n}}\n");
            return;
        }
        let _ = writeln!(text, "fn {name}_load({parameters}) -> Packed {{");
        let _ = write!(text, "{}", self.base());
        let words = (0..self.words()).map(|word| self.read(&self.reference(Some(word))));
        let parts: Vec<String> = is_value.then(|| "key".to_owned()).into_iter().chain(words).collect();
        let _ = writeln!(text, "    return Packed({});\n}}\n", parts.join(", "));
    }

    fn store(&self, text: &mut String) {
        let name = self.name();
        if let Some(scalar) = self.scalar() {
            let parameters = self.parameters(&[&format!("value: {scalar}")]);
            let write = self.write_statement(&self.reference(None), "value");
            let _ = writeln!(text, "fn {name}_store({parameters}) {{\n    {write}\n}}\n");
            return;
        }
        let _ = writeln!(text, "fn {name}_store({}) {{", self.parameters(&["entry: Packed"]));
        let _ = write!(text, "{}", self.base());
        let key = (self.planned.resource.element == Element::Entry).then_some("key");
        let values = self.plan.layout.values.iter().map(|word| word.field.as_str());
        for (word, field) in (0..).zip(key.into_iter().chain(values)) {
            let _ =
                writeln!(text, "    {}", self.write_statement(&self.reference(Some(word)), &format!("entry.{field}")));
        }
        text.push_str("}\n\n");
    }

    /// Writes the accessors of words that are read outside of the critical section.
    fn outside(&self, text: &mut String) {
        let (name, reference) = (self.name(), self.reference(None));
        let scalar = self.scalar().unwrap_or("u32");
        if self.is_called("hint") {
            let (parameters, read) = (self.parameters(&[]), self.read(&reference));
            let _ = writeln!(text, "fn {name}_hint({parameters}) -> {scalar} {{\n    return {read};\n}}\n");
        }
        if self.is_called("publish") && self.access != ShaderAccess::Read {
            let parameters = self.parameters(&[&format!("value: {scalar}")]);
            let write = self.write_statement(&reference, "value");
            let _ = writeln!(text, "fn {name}_publish({parameters}) {{\n    {write}\n}}\n");
        }
    }

    fn atomics(&self, text: &mut String) {
        let (name, reference) = (self.name(), self.reference(None));
        let scalar = self.scalar().unwrap_or("u32");
        let parameters = self.parameters(&[&format!("value: {scalar}")]);
        for (operation, function) in OPERATIONS {
            if !self.is_called(&format!("atomic_{operation}")) {
                continue;
            }
            let _ = writeln!(text, "fn {name}_atomic_{operation}({parameters}) -> {scalar} {{");
            let _ = writeln!(text, "    return {function}(&{reference}, value);\n}}\n");
        }
        if !self.is_called("atomic_compare_exchange") {
            return;
        }
        let parameters = self.parameters(&[&format!("expected: {scalar}"), &format!("value: {scalar}")]);
        let _ = writeln!(text, "fn {name}_atomic_compare_exchange({parameters}) -> bool {{");
        let _ = writeln!(text, "    return atomicCompareExchangeWeak(&{reference}, expected, value).exchanged;\n}}\n");
    }

    fn is_called(&self, accessor: &str) -> bool {
        self.called.iter().any(|name| {
            let rest = name.strip_prefix(self.name()).and_then(|rest| rest.strip_prefix('_'));
            rest == Some(accessor)
        })
    }

    fn parameters(&self, more: &[&str]) -> String {
        let index = self.planned.resource.extents.iter().map(|extent| format!("{}: u32", extent.name));
        index.chain(more.iter().map(|parameter| (*parameter).to_owned())).collect::<Vec<_>>().join(", ")
    }

    /// Returns `let at = …;`, the first word of an element of several words.
    fn base(&self) -> String {
        match self.words() {
            0 | 1 => String::new(),
            words => format!("    let at = {} * {words}u;\n", parenthesised(&self.index())),
        }
    }

    /// Returns the WGSL reference to a word of an element.
    fn reference(&self, word: Option<u64>) -> String {
        let name = self.name();
        match word {
            _ if self.is_single_word() => name.to_owned(),
            Some(0) if self.words() > 1 => format!("{name}[at]"),
            Some(word) if self.words() > 1 => format!("{name}[at + {word}u]"),
            _ => format!("{name}[{}]", self.index()),
        }
    }

    /// Returns the index of an element. The first extent varies slowest.
    fn index(&self) -> String {
        let mut index = String::from("0u");
        let extents = self.planned.resource.extents.iter().zip(&self.planned.lengths);
        for (position, (extent, length)) in extents.enumerate() {
            index = match position {
                0 => extent.name.clone(),
                _ => format!("{} * {} + {}", parenthesised(&index), self.expression(length.term()), extent.name),
            };
        }
        index
    }

    /// Returns a length as WGSL. Symbols that are known at generation are numbers, the others are fields of the frame.
    fn expression(&self, term: &Term) -> String {
        match term {
            Term::Number(number) => format!("{number}u"),
            Term::Symbol(SymbolId::PIXELS) => "pixel_count()".to_owned(),
            Term::Symbol(id) => match &self.plan.symbols.get(*id).value {
                PlanValue::Number(number) => format!("{number}u"),
                _ => format!("frame.{}", self.plan.symbols.get(*id).name),
            },
            Term::Apply(operator, _) if is_boolean(operator) => format!("u32{}", self.condition(term)),
            Term::Apply(operator, arguments) => {
                let parts: Vec<String> = arguments.iter().map(|argument| self.expression(argument)).collect();
                match (*operator, parts.as_slice()) {
                    ("ceil_div", [a, b]) => format!("(({a} + {b} - 1u) / {b})"),
                    ("pow2", [a]) => format!("(1u << {a})"),
                    ("log2_ceil", [a]) => format!("(32u - countLeadingZeros(max({a}, 1u) - 1u))"),
                    ("min" | "max", [a, b]) => format!("{operator}({a}, {b})"),
                    (operator, parts) => format!("({})", parts.join(&format!(" {operator} "))),
                }
            }
        }
    }

    /// Returns a term as a condition in parentheses.
    fn condition(&self, term: &Term) -> String {
        match term {
            Term::Apply(operator @ ("&&" | "||"), arguments) => {
                let parts: Vec<String> = arguments.iter().map(|argument| self.condition(argument)).collect();
                format!("({})", parts.join(&format!(" {operator} ")))
            }
            Term::Apply(operator, arguments) if is_boolean(operator) => {
                let parts: Vec<String> = arguments.iter().map(|argument| self.expression(argument)).collect();
                format!("({})", parts.join(&format!(" {operator} ")))
            }
            _ => format!("({} != 0u)", self.expression(term)),
        }
    }

    fn read(&self, reference: &str) -> String {
        if self.is_atomic() { format!("atomicLoad(&{reference})") } else { reference.to_owned() }
    }

    fn write_statement(&self, reference: &str, value: &str) -> String {
        match self.is_atomic() {
            true => format!("atomicStore(&{reference}, {value});"),
            false => format!("{reference} = {value};"),
        }
    }
}

fn parenthesised(index: &str) -> String {
    if index.contains(' ') { format!("({index})") } else { index.to_owned() }
}

pub(super) fn capitalised(summary: &str) -> String {
    let mut letters = summary.chars();
    letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters).collect()
}
