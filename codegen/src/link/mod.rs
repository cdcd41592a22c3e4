//! Links complete WGSL files to one source: the declarations that the roots reach, in the order of the sources, under a banner
//! per file, with a source map.
//!
//! Renaming works on tokens, so comments and layout do not change. `fold/` removes code without effect. This module does not
//! depend on passes.

mod fold;
mod folded;
mod grammar;
mod index;
mod interned;
mod item;
mod reach;
mod rename;
mod source;
mod token;
mod writer;

pub(crate) use grammar::{GrammarError, grammar_errors};
pub(crate) use item::{FunctionSignature, Item, names, parameter_names, parse as items, signatures, types};
pub(crate) use rename::Renames;
pub(crate) use source::{LinkError, Source};

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::contract::DESCRIBED;
use crate::entry_point::EntryPoint;
use crate::source_map::SourceMap;
use index::Index;
use reach::Reachability;
use source::Items;
use writer::Writer;

/// The result of linking.
#[derive(Debug)]
pub(crate) struct LinkedSource {
    pub(crate) text: String,
    pub(crate) lines: SourceMap,
    pub(crate) entry_points: Vec<EntryPoint>,
    /// Names of the linked declarations, without prefix.
    pub(crate) declared: BTreeSet<String>,
    /// Linked private arrays of fragbuf's own sources, by their names in the linked source.
    pub(crate) private_arrays: Vec<String>,
    /// The printed file headers, by the names of their sources.
    pub(crate) headers: BTreeMap<Arc<str>, String>,
}

/// Links `sources`. The roots are the entry points, or `exports` if there are any. `prefix` precedes every name except entry
/// points. Fails on names that are declared twice, and on an export that no source declares.
pub(crate) fn link(
    header: &str,
    sources: &[Source],
    exports: &[&str],
    prefix: &str,
) -> Result<LinkedSource, LinkError> {
    let lists: Vec<Items<'_>> = sources.iter().map(Source::items).collect::<Result<_, _>>()?;
    let items: Vec<(usize, &Item<'_>)> = lists
        .iter()
        .enumerate()
        .flat_map(|(source, list)| list.as_slice().iter().map(move |item| (source, item)))
        .filter(|(source, item)| !sources[*source].ignored.contains(&item.name))
        .collect();
    let index = declarations(&items, sources)?;
    let before = Reachability::new(&items, &index, exports)?;
    let folded = fold::fold(&items, &index, &before, &|source| sources[source].spans.is_some());
    let reached = if folded.is_empty() { before } else { before.after(&folded, &index) };
    let entry_points: Vec<EntryPoint> = reached
        .ids()
        .filter_map(|id| items[id].1.stage.map(|stage| EntryPoint { name: items[id].1.name.to_owned(), stage }))
        .collect();
    let is_entry = |name: &str| entry_points.iter().any(|entry| entry.name == name);
    let prefixed = Renames::prefix(prefix, index.keys().copied().filter(|name| !is_entry(name)));
    // A header describes the whole file. Without the functions that it describes, only its first paragraph is printed.
    let described = (0..items.len()).filter(|&id| DESCRIBED.contains(&items[id].1.name));
    let described: Vec<(usize, bool)> = described.map(|id| (items[id].0, reached.contains(id))).collect();
    let is_shortened = |source: usize| {
        let mut functions = described.iter().filter(|(other, _)| *other == source).peekable();
        sources[source].spans.is_none() && functions.peek().is_some() && functions.all(|(_, is_linked)| !is_linked)
    };
    let mut headers = BTreeMap::new();
    let mut writer = Writer { text: header.to_owned(), lines: SourceMap::default() };
    writer.lines.skip(header.lines().count());
    let mut current: Option<&str> = None;
    for id in reached.ids() {
        let (source, item) = items[id];
        if current != Some(&sources[source].name) {
            let whole = item::file_header(&sources[source].text);
            let source_header = if is_shortened(source) { item::first_paragraph(&whole) } else { whole };
            writer.banner(&sources[source], &source_header);
            headers.insert(sources[source].name.clone(), source_header);
            current = Some(&sources[source].name);
        }
        match folded.get(&id) {
            Some(folded) => writer.folded(&sources[source], item, folded, &prefixed),
            None => writer.item(&sources[source], item, &prefixed),
        }
    }
    let is_internal = |id: &usize| items[*id].1.is_private_array && sources[items[*id].0].spans.is_none();
    let private_arrays = reached.ids().filter(is_internal).map(|id| format!("{prefix}{}", items[id].1.name)).collect();
    let declared = reached.ids().map(|id| items[id].1.name.to_owned()).collect();
    Ok(LinkedSource { text: writer.text, lines: writer.lines, entry_points, declared, private_arrays, headers })
}

/// Returns where each name is declared. The order of the linked source is the order of the items, not of this map.
fn declarations<'a>(items: &[(usize, &Item<'a>)], sources: &[Source]) -> Result<Index<'a>, LinkError> {
    let mut index = Index::with_capacity_and_hasher(items.len(), Default::default());
    for (id, (_, item)) in items.iter().enumerate() {
        if let Some(first) = index.insert(item.name, id) {
            return Err(declared_twice(items[first], items[id], sources));
        }
    }
    Ok(index)
}

fn declared_twice(first: (usize, &Item<'_>), second: (usize, &Item<'_>), sources: &[Source]) -> LinkError {
    let line = |(source, item): (usize, &Item<'_>)| sources[source].user_line(item.declared_line);
    let (user_line, other) = match (line(first), line(second)) {
        (None, Some(line)) => (Some(line), first.0),
        (line, _) => (line, second.0),
    };
    let problem = match &user_line {
        Some(_) => format!("`{}` is also declared in {}", first.1.name, sources[other].name),
        None => format!("`{}` is declared twice", first.1.name),
    };
    LinkError { problem, user_line }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn source(name: &str, text: &str) -> Source {
        Source::generated(name, text.to_owned())
    }

    #[test]
    fn links_only_reachable_declarations() {
        let library =
            source("a", "const USED = 1u;\nconst UNUSED = 2u;\n\n/// Doc.\nfn f() -> u32 {\n    return USED;\n}\n");
        let main = source("b", "// Header.\n\n@compute @workgroup_size(1)\nfn main() {\n    _ = f();\n}\n");
        let linked = link("// h\n", &[library, main], &[], "").unwrap();
        let expected = "// h\n\n// ---- generated/a\nconst USED = 1u;\n\n/// Doc.\nfn f() -> u32 {\n    return USED;\n}\n\n\
                        // ---- generated/b\n// Header.\n\n@compute @workgroup_size(1)\nfn main() {\n    _ = f();\n}\n\n";
        assert_eq!(linked.text, expected);
        assert_eq!(linked.entry_points.len(), 1);
        let line = linked.text.lines().position(|line| line.contains("return USED")).unwrap() + 1;
        assert_eq!(
            linked.lines.source(line),
            crate::source_map::LineSource::Source { name: "generated/a".into(), line: 6 }
        );
    }

    #[test]
    fn two_declarations_of_one_name_are_rejected() {
        let sources = [source("a", "const X = 1u;\n"), source("b", "const X = 2u;\n")];
        assert_eq!(link("", &sources, &["X"], "").err(), Some("`X` is declared twice".to_owned().into()));
    }

    #[test]
    fn prefixes_leave_entry_points_members_and_other_locals() {
        let text = "struct S {\n    x: u32,\n}\nvar<private> s: S;\n@compute @workgroup_size(1)\nfn main() {\n    s.x = 1u;\n}\n";
        let linked = link("", &[source("a", text)], &[], "p_").unwrap();
        assert!(linked.text.contains("struct p_S {\n    x: u32,"));
        assert!(linked.text.contains("var<private> p_s: p_S;"));
        assert!(linked.text.contains("fn main() {\n    p_s.x = 1u;"));
    }
}
