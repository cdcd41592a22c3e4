//! How a fragment lies in memory: the words of one entry, the key first.

use fragbuf_model::{Attribute, Format, Variant, mangled};
use fragbuf_templates::vocabulary::Order;

/// The words of one stored fragment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// What the first word is.
    pub key: Key,
    /// The words after it, in memory order.
    pub beside: Vec<Word>,
}

/// What fragments are ordered by when one must go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// The bits of the depth: the payload's own word, which costs no memory of its own.
    Depth,
    /// The ordered bits of the criterion's value: one word beside the whole payload.
    Criterion,
}

/// One word beside the key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// Its field in `Packed`.
    pub field: String,
    /// The attribute that it holds, or a part of.
    pub attribute: Attribute,
    /// The components that it holds, for a vector of several words.
    pub components: Option<&'static str>,
}

impl Layout {
    /// The layout of a variant's payload: words in the user's order, depth as the key unless there is a criterion. The
    /// attribute that decides ties comes first, so that the order of words is the order of fragments.
    pub fn of(variant: &Variant) -> Self {
        let key = if variant.criterion.is_some() { Key::Criterion } else { Key::Depth };
        let mut beside: Vec<Word> = Vec::new();
        let first = tie_breaker(variant);
        let others = variant.attributes.iter().filter(|attribute| Some(*attribute) != first);
        for attribute in first.into_iter().chain(others) {
            if key == Key::Depth && attribute.name.value == "depth" {
                continue;
            }
            for part in parts(attribute.format.value) {
                let suffix = part.map_or(String::new(), |letters| format!("_{letters}"));
                let name = format!("{}{suffix}", mangled(&attribute.name.value));
                beside.push(Word { field: unused(name, &beside), attribute: attribute.clone(), components: part });
            }
        }
        Layout { key, beside }
    }

    /// Words of an entry, the key included.
    pub fn entry_words(&self) -> u32 {
        self.beside_words() + 1
    }

    /// Words of an entry beside the key.
    pub fn beside_words(&self) -> u32 {
        self.beside.len() as u32
    }

    /// The field that holds the depth.
    pub fn depth_field(&self) -> &str {
        let depth = self.beside.iter().find(|word| word.attribute.name.value == "depth");
        depth.map_or("key", |word| &word.field)
    }
}

/// The attribute that decides between fragments with equal keys before all others, if the description names one.
fn tie_breaker(variant: &Variant) -> Option<&Attribute> {
    let mut rows = variant.choices.iter().flat_map(|chosen| &chosen.alternatives);
    let ties = rows.find(|selected| selected.row.order == Some(Order::Attribute))?;
    let index = ties.options.first().map_or(0, |(_, index)| *index);
    variant.attributes.get(index as usize)
}

fn parts(format: Format) -> Vec<Option<&'static str>> {
    match format {
        Format::Vec2 => vec![Some("x"), Some("y")],
        Format::Rgba16 => vec![Some("xy"), Some("zw")],
        Format::Vec3 => vec![Some("x"), Some("y"), Some("z")],
        Format::Vec4 => vec![Some("x"), Some("y"), Some("z"), Some("w")],
        Format::F32 | Format::U32 | Format::Rgba8 | Format::Octahedral => vec![None],
    }
}

/// `name`, or with `_` appended until neither the key nor another word has it.
fn unused(mut name: String, words: &[Word]) -> String {
    while name == "key" || words.iter().any(|word| word.field == name) {
        name.push('_');
    }
    name
}
