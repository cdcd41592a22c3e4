//! Whole WGSL files in, one text out: the declarations that the roots reach, in the order of the sources, under a banner
//! per file, with a record of where every line comes from.
//!
//! Renaming works on tokens, so comments and layout stay as they were written. `fold/` removes code without effect. Passes
//! are unknown here.

mod fold;
mod index;
mod interned;
mod item;
mod reach;
mod rename;
mod token;
mod writer;

pub(crate) use item::{Head, Item, head, heads, names, parse as items, shape};
pub(crate) use rename::Renames;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, LazyLock, Mutex};

use fragbuf_model::{Origin, UserFunction};
use fragbuf_templates::vocabulary::Template;

use crate::contract::{CONTRACTS, DESCRIBED};
use crate::program::{EntryPoint, LineMap, LineOrigin};
use index::Index;
use interned::interned;
use reach::Reached;
use writer::Writer;

/// A text to link.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// Its banner, and what the line map calls it.
    name: Arc<str>,
    text: Cow<'static, str>,
    /// Where each line comes from, if not from the line of that number in this source.
    origins: Option<Vec<LineOrigin>>,
    /// Names that it leaves to other sources.
    left: Vec<&'static str>,
}

impl Source {
    /// Text made for this program.
    pub(crate) fn generated(name: &str, text: String) -> Self {
        Source { name: format!("generated/{name}").into(), text: interned(text), origins: None, left: Vec::new() }
    }

    /// A template, renamed for its instance.
    pub(crate) fn template(template: &Template, renames: &Renames) -> Self {
        let text = match &template.text {
            Cow::Borrowed(text) => renames.apply(text),
            Cow::Owned(text) => Cow::Owned(renames.apply(text).into_owned()),
        };
        let text = match text {
            Cow::Borrowed(text) => Cow::Borrowed(text),
            Cow::Owned(text) => interned(text),
        };
        let origins = template.own.as_deref().map(|file| own_lines(&template.text, file));
        Source { name: template.path.as_ref().into(), text, origins, left: Vec::new() }
    }

    /// The same without the declarations that others make.
    pub(crate) fn leaving(self, left: Vec<&'static str>) -> Self {
        Source { left, ..self }
    }

    /// The functions of contracts that it declares.
    pub(crate) fn fulfilled(&self) -> Vec<&'static str> {
        match self.items() {
            Ok(Items::Kept(text)) => text.fulfilled.clone(),
            Ok(Items::Parsed(items)) => fulfilled(&items),
            // Linking reports what cannot be read.
            Err(_) => Vec::new(),
        }
    }

    /// A user's function. Its banner does not name the user's file: the same description gives the same text wherever it
    /// lies.
    pub(crate) fn user(function: &UserFunction) -> Self {
        let origins = function.lines.iter().cloned().map(LineOrigin::User).collect();
        Source {
            name: "description".into(),
            text: interned(function.wgsl.clone()),
            origins: Some(origins),
            left: Vec::new(),
        }
    }

    /// Whether these words stand anywhere in it.
    pub(crate) fn mentions(&self, words: &str) -> bool {
        self.text.contains(words)
    }

    /// The same with a depth test forced before its fragment stage. The attribute stands on the stage's own line: lines keep
    /// their numbers.
    pub(crate) fn with_early_depth(mut self) -> Result<Self, String> {
        let text = self.text.replacen("\n@fragment\n", "\n@early_depth_test(force) @fragment\n", 1);
        if text == self.text {
            return Err(format!("{} has no line `@fragment`", self.name));
        }
        self.text = interned(text);
        Ok(self)
    }

    /// The atomic accessors that its declarations mention: buffers offer many, and few are ever used.
    pub(crate) fn atomic_accessors(&self) -> Vec<String> {
        match self.items() {
            Ok(Items::Kept(text)) => text.atomic_accessors.iter().map(|name| (*name).to_owned()).collect(),
            Ok(Items::Parsed(items)) => atomic_accessors(&items).into_iter().map(str::to_owned).collect(),
            // Linking says what is wrong with it.
            Err(_) => Vec::new(),
        }
    }

    fn items(&self) -> Result<Items<'_>, Fault> {
        let parsed = match &self.text {
            Cow::Borrowed(text) => kept_items(text).map(Items::Kept),
            Cow::Owned(text) => item::parse(text).map(Items::Parsed),
        };
        parsed.map_err(|line| Fault {
            problem: format!("{}:{line}: not a declaration", self.name),
            own: self.own_line(line),
        })
    }

    /// The place of a line, in a file of the user's own.
    fn own_line(&self, line: usize) -> Option<Origin> {
        match self.origins.as_ref()?.get(line.checked_sub(1)?)? {
            LineOrigin::Own(origin) => Some(origin.clone()),
            _ => None,
        }
    }
}

/// Why texts cannot be linked.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    /// What is wrong.
    pub(crate) problem: String,
    /// The line that is at fault, where it is one of a user's own file.
    pub(crate) own: Option<Origin>,
}

impl From<String> for Fault {
    fn from(problem: String) -> Self {
        Fault { problem, own: None }
    }
}

/// The lines of a user's own file, each from its first sign to its last.
fn own_lines(text: &str, file: &str) -> Vec<LineOrigin> {
    let file: Arc<str> = file.into();
    let place = |(line, text): (u32, &str)| {
        let indent = text.chars().count() - text.trim_start().chars().count();
        let length = text.trim().chars().count() as u32;
        LineOrigin::Own(Origin::new(file.clone(), line, indent as u32 + 1).with_length(length))
    };
    (1..).zip(text.lines()).map(place).collect()
}

/// The declarations of a source: a template's are found once and kept.
enum Items<'a> {
    Kept(Arc<KeptText>),
    Parsed(Vec<Item<'a>>),
}

impl Items<'_> {
    fn as_slice(&self) -> &[Item<'_>] {
        match self {
            Items::Kept(text) => &text.items,
            Items::Parsed(items) => items,
        }
    }
}

/// What is known of a text that lives as long as the program does.
struct KeptText {
    items: Vec<Item<'static>>,
    fulfilled: Vec<&'static str>,
    atomic_accessors: Vec<&'static str>,
}

fn kept_items(text: &'static str) -> Result<Arc<KeptText>, usize> {
    type Kept = BTreeMap<(usize, usize), Arc<KeptText>>;
    static KEPT: LazyLock<Mutex<Kept>> = LazyLock::new(Mutex::default);
    let key = (text.as_ptr() as usize, text.len());
    // A thread that panicked while holding the lock left only whole entries behind.
    let mut kept = KEPT.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(text) = kept.get(&key) {
        return Ok(text.clone());
    }
    let items = item::parse(text)?;
    let (fulfilled, atomic_accessors) = (fulfilled(&items), atomic_accessors(&items));
    let known = Arc::new(KeptText { items, fulfilled, atomic_accessors });
    kept.insert(key, known.clone());
    Ok(known)
}

/// The functions of contracts among declarations.
fn fulfilled(items: &[Item<'_>]) -> Vec<&'static str> {
    let named = |item: &Item<'_>| CONTRACTS.iter().map(|contract| contract.name).find(|name| *name == item.name);
    items.iter().filter(|item| item.is_function).filter_map(named).collect()
}

fn atomic_accessors<'a>(items: &[Item<'a>]) -> Vec<&'a str> {
    items.iter().flat_map(|item| item.mentions.iter().copied()).filter(|name| name.contains("_atomic_")).collect()
}

/// What linking yields.
#[derive(Debug)]
pub(crate) struct Linked {
    pub(crate) text: String,
    pub(crate) lines: LineMap,
    pub(crate) entry_points: Vec<EntryPoint>,
    /// Names of the declarations that were linked, before the prefix.
    pub(crate) declared: BTreeSet<String>,
    /// Private arrays of sources of ours that were linked, as the text names them.
    pub(crate) private_arrays: Vec<String>,
    /// The heads that were printed, by the names of their sources.
    pub(crate) heads: BTreeMap<Arc<str>, String>,
}

/// Links `sources`. Roots are the entry points, or `exports` where there are any. `prefix` goes before every name but the
/// entry points'. `Err`: names that sources declare twice, or an export that none declares.
pub(crate) fn link(header: &str, sources: &[Source], exports: &[&str], prefix: &str) -> Result<Linked, Fault> {
    let lists: Vec<Items<'_>> = sources.iter().map(Source::items).collect::<Result<_, _>>()?;
    let items: Vec<(usize, &Item<'_>)> = lists
        .iter()
        .enumerate()
        .flat_map(|(source, list)| list.as_slice().iter().map(move |item| (source, item)))
        .filter(|(source, item)| !sources[*source].left.contains(&item.name))
        .collect();
    let index = declarations(&items, sources)?;
    let before = Reached::new(&items, &index, exports)?;
    let folded = fold::fold(&items, &index, &before, &|source| sources[source].origins.is_some());
    let reached = if folded.is_empty() { before } else { before.after(&folded, &index) };
    let entry_points: Vec<EntryPoint> = reached
        .ids()
        .filter_map(|id| items[id].1.stage.map(|stage| EntryPoint { name: items[id].1.name.to_owned(), stage }))
        .collect();
    let is_entry = |name: &str| entry_points.iter().any(|entry| entry.name == name);
    let prefixed = Renames::prefix(prefix, index.keys().copied().filter(|name| !is_entry(name)));
    // A head is about the whole file: where the functions are missing that it describes, its first paragraph is enough.
    let described = (0..items.len()).filter(|&id| DESCRIBED.contains(&items[id].1.name));
    let described: Vec<(usize, bool)> = described.map(|id| (items[id].0, reached.contains(id))).collect();
    let in_brief = |source: usize| {
        let mut own = described.iter().filter(|(other, _)| *other == source).peekable();
        sources[source].origins.is_none() && own.peek().is_some() && own.all(|(_, is_linked)| !is_linked)
    };
    let mut heads = BTreeMap::new();
    let mut writer = Writer { text: header.to_owned(), lines: LineMap::default() };
    writer.lines.skip(header.lines().count());
    let mut current: Option<&str> = None;
    for id in reached.ids() {
        let (source, item) = items[id];
        if current != Some(&sources[source].name) {
            let whole = head(&sources[source].text);
            let head = if in_brief(source) { item::first_paragraph(&whole) } else { whole };
            writer.banner(&sources[source], &head);
            heads.insert(sources[source].name.clone(), head);
            current = Some(&sources[source].name);
        }
        match folded.get(&id) {
            Some(folded) => writer.folded(&sources[source], item, folded, &prefixed),
            None => writer.item(&sources[source], item, &prefixed),
        }
    }
    let is_ours = |id: &usize| items[*id].1.is_private_array && sources[items[*id].0].origins.is_none();
    let private_arrays = reached.ids().filter(is_ours).map(|id| format!("{prefix}{}", items[id].1.name)).collect();
    let declared = reached.ids().map(|id| items[id].1.name.to_owned()).collect();
    Ok(Linked { text: writer.text, lines: writer.lines, entry_points, declared, private_arrays, heads })
}

/// Where each name is declared. Looked up only: the order of the text is the order of the items.
fn declarations<'a>(items: &[(usize, &Item<'a>)], sources: &[Source]) -> Result<Index<'a>, Fault> {
    let mut index = Index::with_capacity_and_hasher(items.len(), Default::default());
    for (id, (_, item)) in items.iter().enumerate() {
        if let Some(first) = index.insert(item.name, id) {
            return Err(declared_twice(items[first], items[id], sources));
        }
    }
    Ok(index)
}

fn declared_twice(first: (usize, &Item<'_>), second: (usize, &Item<'_>), sources: &[Source]) -> Fault {
    let own = |(source, item): (usize, &Item<'_>)| sources[source].own_line(item.declared_line);
    let (place, other) = match (own(first), own(second)) {
        (None, Some(place)) => (Some(place), first.0),
        (place, _) => (place, second.0),
    };
    let problem = match &place {
        Some(_) => format!("`{}` is declared in {} too", first.1.name, sources[other].name),
        None => format!("`{}` is declared twice", first.1.name),
    };
    Fault { problem, own: place }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn source(name: &str, text: &str) -> Source {
        Source::generated(name, text.to_owned())
    }

    #[test]
    fn only_what_is_reached_is_linked() {
        let library =
            source("a", "const USED = 1u;\nconst UNUSED = 2u;\n\n/// Doc.\nfn f() -> u32 {\n    return USED;\n}\n");
        let main = source("b", "// Head.\n\n@compute @workgroup_size(1)\nfn main() {\n    _ = f();\n}\n");
        let linked = link("// h\n", &[library, main], &[], "").unwrap();
        let expected = "// h\n\n// ---- generated/a\nconst USED = 1u;\n\n/// Doc.\nfn f() -> u32 {\n    return USED;\n}\n\n\
                        // ---- generated/b\n// Head.\n\n@compute @workgroup_size(1)\nfn main() {\n    _ = f();\n}\n\n";
        assert_eq!(linked.text, expected);
        assert_eq!(linked.entry_points.len(), 1);
        let line = linked.text.lines().position(|line| line.contains("return USED")).unwrap() + 1;
        assert_eq!(linked.lines.origin(line), LineOrigin::Source { name: "generated/a".into(), line: 6 });
    }

    #[test]
    fn two_declarations_of_one_name_are_refused() {
        let sources = [source("a", "const X = 1u;\n"), source("b", "const X = 2u;\n")];
        assert_eq!(link("", &sources, &["X"], "").err(), Some("`X` is declared twice".to_owned().into()));
    }

    #[test]
    fn prefixes_spare_entry_points_members_and_locals_of_other_names() {
        let text = "struct S {\n    x: u32,\n}\nvar<private> s: S;\n@compute @workgroup_size(1)\nfn main() {\n    s.x = 1u;\n}\n";
        let linked = link("", &[source("a", text)], &[], "p_").unwrap();
        assert!(linked.text.contains("struct p_S {\n    x: u32,"));
        assert!(linked.text.contains("var<private> p_s: p_S;"));
        assert!(linked.text.contains("fn main() {\n    p_s.x = 1u;"));
    }
}
