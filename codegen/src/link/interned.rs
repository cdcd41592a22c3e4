//! Texts that live as long as the program does, so that what is found out about one is found out once: templates anyway, and
//! the generated and renamed texts that passes, profiles and variants share.
//!
//! In: a text. Out: the same, kept if there is room. The room is bounded: a program that makes ever new texts keeps the
//! first ones and reads the others each time.

use std::borrow::Cow;
use std::collections::HashSet;
use std::hash::BuildHasherDefault;
use std::sync::{LazyLock, Mutex, PoisonError};

use super::index::Words;

/// Bytes that are kept at most: all techniques for all targets take 125 kB.
const MOST: usize = 2 << 20;

#[derive(Default)]
struct Texts {
    texts: HashSet<&'static str, BuildHasherDefault<Words>>,
    bytes: usize,
}

/// The text, and for as long as the program lives if there is room.
pub(super) fn interned(text: String) -> Cow<'static, str> {
    static TEXTS: LazyLock<Mutex<Texts>> = LazyLock::new(Mutex::default);
    // A thread that panicked while holding the lock left only whole entries behind.
    let mut kept = TEXTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.texts.get(text.as_str()) {
        return Cow::Borrowed(known);
    }
    if kept.bytes + text.len() > MOST {
        return Cow::Owned(text);
    }
    kept.bytes += text.len();
    let text: &'static str = Box::leak(text.into_boxed_str());
    kept.texts.insert(text);
    Cow::Borrowed(text)
}
