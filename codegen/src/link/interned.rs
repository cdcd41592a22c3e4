//! Interns generated and renamed sources that passes, profiles and variants share, so that each is parsed once. Templates are static
//! already.
//!
//! Input: a source. Output: the same source, interned unless the limit is reached. A program with more sources interns the first
//! ones and parses the others each time.

use std::borrow::Cow;
use std::collections::HashSet;
use std::hash::BuildHasherDefault;
use std::sync::{LazyLock, Mutex, PoisonError};

use super::index::NameHasher;

/// The limit in bytes. All techniques for all targets take 125 kB.
const MAX_BYTES: usize = 2 << 20;

/// The interned sources.
#[derive(Default)]
struct Interner {
    sources: HashSet<&'static str, BuildHasherDefault<NameHasher>>,
    bytes: usize,
}

/// Returns the source with a static lifetime, or owned if the limit is reached.
pub(super) fn interned(text: String) -> Cow<'static, str> {
    static INTERNER: LazyLock<Mutex<Interner>> = LazyLock::new(Mutex::default);
    // A thread that panicked while holding the lock left only complete entries.
    let mut interner = INTERNER.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = interner.sources.get(text.as_str()) {
        return Cow::Borrowed(known);
    }
    if interner.bytes + text.len() > MAX_BYTES {
        return Cow::Owned(text);
    }
    interner.bytes += text.len();
    let text: &'static str = Box::leak(text.into_boxed_str());
    interner.sources.insert(text);
    Cow::Borrowed(text)
}
