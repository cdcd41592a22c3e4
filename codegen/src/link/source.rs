//! The sources that are linked: templates, generated code, functions of a description.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex};

use fragbuf_model::{SourceSpan, UserFunction};
use fragbuf_templates::vocabulary::Template;

use super::interned::interned;
use super::item::{self, Item};
use super::rename::Renames;
use crate::contract::CONTRACTS;
use crate::source_map::LineSource;

/// A WGSL source to link.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// Its name in banners and source maps.
    pub(super) name: Arc<str>,
    pub(super) text: Cow<'static, str>,
    /// The origin of each line, if it is not the line of the same number in this source.
    pub(super) spans: Option<Vec<LineSource>>,
    /// Names whose declarations in this source are ignored.
    pub(super) ignored: Vec<&'static str>,
}

impl Source {
    /// Returns a source that was generated for this program.
    pub(crate) fn generated(name: &str, text: String) -> Self {
        Source { name: format!("generated/{name}").into(), text: interned(text), spans: None, ignored: Vec::new() }
    }

    /// Returns a template with the names of its instance.
    pub(crate) fn template(template: &Template, renames: &Renames) -> Self {
        let text = match &template.source {
            Cow::Borrowed(text) => renames.apply(text),
            Cow::Owned(text) => Cow::Owned(renames.apply(text).into_owned()),
        };
        let text = match text {
            Cow::Borrowed(text) => Cow::Borrowed(text),
            Cow::Owned(text) => interned(text),
        };
        let spans = template.user_file.as_deref().map(|file| user_file_lines(&template.source, file));
        Source { name: template.path.as_ref().into(), text, spans, ignored: Vec::new() }
    }

    /// Returns the source without the declarations of these names.
    pub(crate) fn without(self, ignored: Vec<&'static str>) -> Self {
        Source { ignored, ..self }
    }

    /// Returns the contract functions that it declares.
    pub(crate) fn implemented(&self) -> Vec<&'static str> {
        match self.items() {
            Ok(Items::Cached(text)) => text.implemented.clone(),
            Ok(Items::Parsed(items)) => implemented(&items),
            // `link` reports sources that cannot be parsed.
            Err(_) => Vec::new(),
        }
    }

    /// Returns a function of the description. Its banner does not name the user's file, so that output does not depend on paths.
    pub(crate) fn user(function: &UserFunction) -> Self {
        let spans = function.lines.iter().cloned().map(LineSource::Description).collect();
        Source {
            name: "description".into(),
            text: interned(function.wgsl.clone()),
            spans: Some(spans),
            ignored: Vec::new(),
        }
    }

    /// Tests whether the source contains this string.
    pub(crate) fn mentions(&self, words: &str) -> bool {
        self.text.contains(words)
    }

    /// Returns the source with an early depth test forced on its fragment stage. The attribute is added to the line of the stage, so
    /// line numbers do not change.
    pub(crate) fn with_early_depth(mut self) -> Result<Self, String> {
        let text = self.text.replacen("\n@fragment\n", "\n@early_depth_test(force) @fragment\n", 1);
        if text == self.text {
            return Err(format!("{} has no line `@fragment`", self.name));
        }
        self.text = interned(text);
        Ok(self)
    }

    /// Returns the accessors other than loads and stores that its declarations mention. Buffers could have many, and few are used.
    pub(crate) fn further_accessors(&self) -> Vec<String> {
        match self.items() {
            Ok(Items::Cached(text)) => text.further_accessors.iter().map(|name| (*name).to_owned()).collect(),
            Ok(Items::Parsed(items)) => further_accessors(&items).into_iter().map(str::to_owned).collect(),
            // `link` reports sources that cannot be parsed.
            Err(_) => Vec::new(),
        }
    }

    pub(super) fn items(&self) -> Result<Items<'_>, LinkError> {
        let parsed = match &self.text {
            Cow::Borrowed(text) => cached_items(text).map(Items::Cached),
            Cow::Owned(text) => item::parse(text).map(Items::Parsed),
        };
        parsed.map_err(|line| LinkError {
            problem: format!("{}:{line}: not a declaration", self.name),
            user_line: self.user_line(line),
        })
    }

    /// Returns the span of a line in a user file.
    pub(super) fn user_line(&self, line: usize) -> Option<SourceSpan> {
        match self.spans.as_ref()?.get(line.checked_sub(1)?)? {
            LineSource::UserFile(span) => Some(span.clone()),
            _ => None,
        }
    }
}

/// An error of linking.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinkError {
    /// The message.
    pub(crate) problem: String,
    /// The line of the error, if it is in a user file.
    pub(crate) user_line: Option<SourceSpan>,
}

impl From<String> for LinkError {
    fn from(problem: String) -> Self {
        LinkError { problem, user_line: None }
    }
}

/// Returns the origins of the lines of a user file, without surrounding spaces.
fn user_file_lines(text: &str, file: &str) -> Vec<LineSource> {
    let file: Arc<str> = file.into();
    let origin = |(line, text): (u32, &str)| {
        let indent = text.chars().count() - text.trim_start().chars().count();
        let length = text.trim().chars().count() as u32;
        LineSource::UserFile(SourceSpan::new(file.clone(), line, indent as u32 + 1).with_length(length))
    };
    (1..).zip(text.lines()).map(origin).collect()
}

/// The declarations of a source. Those of interned sources are parsed once and cached.
pub(super) enum Items<'a> {
    Cached(Arc<CachedSource>),
    Parsed(Vec<Item<'a>>),
}

impl Items<'_> {
    pub(super) fn as_slice(&self) -> &[Item<'_>] {
        match self {
            Items::Cached(text) => &text.items,
            Items::Parsed(items) => items,
        }
    }
}

/// The parsed form of an interned source.
pub(super) struct CachedSource {
    items: Vec<Item<'static>>,
    implemented: Vec<&'static str>,
    further_accessors: Vec<&'static str>,
}

fn cached_items(text: &'static str) -> Result<Arc<CachedSource>, usize> {
    type Cache = BTreeMap<(usize, usize), Arc<CachedSource>>;
    static CACHE: LazyLock<Mutex<Cache>> = LazyLock::new(Mutex::default);
    let key = (text.as_ptr() as usize, text.len());
    // A thread that panicked while holding the lock left only complete entries.
    let mut cache = CACHE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(text) = cache.get(&key) {
        return Ok(text.clone());
    }
    let items = item::parse(text)?;
    let (implemented, further_accessors) = (implemented(&items), further_accessors(&items));
    let parsed = Arc::new(CachedSource { items, implemented, further_accessors });
    cache.insert(key, parsed.clone());
    Ok(parsed)
}

/// Returns the contract functions among declarations.
fn implemented(items: &[Item<'_>]) -> Vec<&'static str> {
    let named = |item: &Item<'_>| CONTRACTS.iter().map(|contract| contract.name).find(|name| *name == item.name);
    items.iter().filter(|item| item.is_function).filter_map(named).collect()
}

/// Returns the accessors other than loads and stores that declarations mention.
fn further_accessors<'a>(items: &[Item<'a>]) -> Vec<&'a str> {
    let is_further = |name: &&str| name.contains("_atomic_") || name.ends_with("_hint") || name.ends_with("_publish");
    items.iter().flat_map(|item| item.mentions.iter().copied()).filter(is_further).collect()
}
