//! The outline of a description: the buffer, and its items.
//!
//! Input: a document. Output: symbols with their places. A text without a buffer has none.

use fragbuf_model::SourceSpan;

use super::context::items;
use super::{Document, TextSpan};

/// An item of a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// The name.
    pub name: String,
    /// The type or the value; may be empty.
    pub detail: String,
    /// The kind.
    pub kind: SymbolKind,
    /// The whole item.
    pub span: TextSpan,
    /// The name in it.
    pub name_span: TextSpan,
    /// The items in it.
    pub children: Vec<Symbol>,
}

/// The kind of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SymbolKind {
    /// A buffer.
    Buffer,
    /// An attribute.
    Attribute,
    /// A uniform.
    Uniform,
    /// A choice, or `keep`.
    Choice,
    /// A closure or a `fn`.
    Function,
}

impl Document<'_> {
    /// Returns the buffer with its items, in the order of the text.
    pub fn outline(&self) -> Option<Symbol> {
        let draft = if self.is_too_long() { None } else { self.draft() }?;
        let (lines, ranges) = (self.lines(), items(self.text));
        let symbol = |name: &str, detail: &str, kind, span: &SourceSpan| {
            let name_span = lines.source_span(span);
            let at = name_span.bytes.start;
            let item = ranges.iter().find(|item| item.start <= at && at < item.end);
            let is_entry = matches!(kind, SymbolKind::Attribute | SymbolKind::Uniform);
            let whole = item.filter(|_| !is_entry).map_or(name_span.clone(), |item| lines.span(item.clone()));
            let (name, detail) = (name.to_owned(), detail.to_owned());
            // An item that is repaired may be elsewhere than its name.
            let is_inside = whole.bytes.start <= at && name_span.bytes.end <= whole.bytes.end;
            let span = if is_inside { whole } else { name_span.clone() };
            Symbol { name, detail, kind, span, name_span, children: Vec::new() }
        };
        let mut children: Vec<Symbol> = Vec::new();
        children.extend(draft.attributes.iter().map(|attribute| {
            let format = attribute.format.value.keyword();
            symbol(&attribute.name.value, format, SymbolKind::Attribute, &attribute.name.span)
        }));
        children.extend(draft.uniforms.iter().map(|uniform| {
            symbol(&uniform.name.value, uniform.kind.value.keyword(), SymbolKind::Uniform, &uniform.name.span)
        }));
        children.extend(draft.keep.iter().map(|keep| {
            let span = lines.source_span(&keep.count.span).bytes;
            symbol("keep", self.text.get(span).unwrap_or_default(), SymbolKind::Choice, &keep.count.span)
        }));
        children.extend(draft.choices.iter().map(|choice| {
            let values: Vec<&str> = choice.alternatives.iter().map(|alternative| &*alternative.value.value).collect();
            symbol(&choice.axis.value, &values.join(" else "), SymbolKind::Choice, &choice.axis.span)
        }));
        let constraints = draft.constraints.iter().map(|closure| ("where", closure));
        let effects = draft.resolve.iter().map(|closure| ("resolve", closure));
        let helpers =
            draft.helpers.iter().map(|helper| (helper.name.strip_prefix("user_").unwrap_or(&helper.name), helper));
        let functions = constraints.chain(effects).chain(helpers);
        children.extend(functions.map(|(name, closure)| symbol(name, "", SymbolKind::Function, &closure.span)));
        children.sort_by_key(|child| child.span.bytes.start);
        let detail = draft.preset.as_ref().map_or(String::new(), |preset| format!("from {}", preset.value));
        let buffer = symbol(&draft.name.value, &detail, SymbolKind::Buffer, &draft.name.span);
        let end = children.iter().map(|child| child.span.bytes.end).max().unwrap_or_default();
        let start = buffer.name_span.bytes.start;
        let end = end.max(self.text.trim_end().len()).max(buffer.name_span.bytes.end);
        Some(Symbol { span: lines.span(start..end), children, ..buffer })
    }
}
