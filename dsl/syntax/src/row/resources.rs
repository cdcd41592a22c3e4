//! Lines that declare a buffer.
//!
//! Input: a line after its keyword. Output: a resource of the row, and the symbols that its formulas may use.

use fragbuf_model::{Diagnostic, codes};
use fragbuf_templates::vocabulary::{BindingTime, Element, Init, Lifetime, Resource, RowItem, SYMBOLS};

use super::line::Line;
use super::reader::Read;
use super::statements::{Statements, summary};
use crate::report::{FIRST, Stop};
use crate::unknown_name;

/// The kinds of elements.
const ELEMENTS: [(&str, Element); 3] = [("word", Element::Word), ("entry", Element::Entry), ("value", Element::Value)];

/// The names that generated accessors use for other purposes than an index.
const ACCESSOR_NAMES: [&str; 5] = ["at", "key", "value", "entry", "expected"];

impl Statements {
    /// Parses `buffer name[index < length]…: element, clear 0, host, persistent -- summary`.
    pub(super) fn buffer(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`buffer heads[pixel < pixels]: word`";
        let name = self.reader.wgsl_name(line, "a buffer's name", SHAPE)?;
        self.declared.push(name.value.clone());
        let mut resource = Resource::new(&name.value, Element::Word, summary(line));
        while line.punct('[') {
            resource = self.extent(line, resource)?;
        }
        self.reader.punct(line, ':', SHAPE)?;
        let element = self.reader.name(line, "an element", "`word`, `entry` or `value`")?;
        resource.element = self.reader.one_of(&element, &ELEMENTS, "an element")?;
        while line.punct(',') {
            let attribute = self.reader.name(line, "an attribute", "`clear 0`, `host` or `persistent`")?;
            match attribute.value.as_str() {
                "clear" => resource.init = Init::Clear(self.reader.number(line)?.value),
                "host" => resource.init = Init::External,
                "persistent" => resource.lifetime = Lifetime::Persistent,
                other => {
                    let help = unknown_name::help(other, &["clear", "host", "persistent"]);
                    let message = format!("expected an attribute of a buffer, found `{other}`");
                    return self.reader.stop(codes::INVALID_ROW, &attribute.span, message, help);
                }
            }
        }
        let known = self.user_row.row.resources.iter().position(|other| other.name == name.value);
        if let Some(first) = known {
            let message = format!("duplicate buffer `{}`", name.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.span, message, "remove one of them");
            self.reader.diagnostics.push(diagnostic.label(&self.user_row.spans.resources[first], FIRST));
            return Err(Stop);
        }
        self.reader.record_span(RowItem::Resource, &name);
        self.user_row.row.resources.push(resource);
        self.user_row.spans.resources.push(name.span);
        Ok(())
    }

    /// Parses `index < length]`.
    fn extent(&mut self, line: &mut Line<'_>, resource: Resource) -> Read<Resource> {
        const SHAPE: &str = "`[pixel < pixels]`";
        let index = self.reader.wgsl_name(line, "an index", SHAPE)?;
        let is_taken = resource.extents.iter().any(|extent| extent.name == index.value);
        if is_taken || ACCESSOR_NAMES.contains(&index.value.as_str()) {
            let message = format!("the buffer's accessors already use the name `{}`", index.value);
            let help = "choose another name, such as `slot` or `pixel`";
            return self.reader.stop(codes::INVALID_ROW, &index.span, message, help);
        }
        self.reader.punct(line, '<', SHAPE)?;
        let length = line.formula(&[']']);
        self.reader.punct(line, ']', SHAPE)?;
        let symbols = self.symbols();
        self.reader.formula(&length, &symbols)?;
        self.reader.record_span(RowItem::Length, &length);
        Ok(resource.by(&index.value, length.value))
    }

    /// Returns the symbols that formulas of the row may use: those that have a value before a pass runs and do not change
    /// between slices or iterations, and the row's constants so far.
    pub(super) fn symbols(&self) -> Vec<String> {
        self.symbols_until(BindingTime::Readback)
    }

    /// Returns the symbols that have a value at this time, and the row's constants so far.
    pub(super) fn symbols_until(&self, time: BindingTime) -> Vec<String> {
        let known = SYMBOLS.iter().filter(|symbol| symbol.when <= time).map(|symbol| symbol.name.to_owned());
        known.chain(self.user_row.row.parameters.iter().map(|parameter| parameter.constant.to_string())).collect()
    }
}
