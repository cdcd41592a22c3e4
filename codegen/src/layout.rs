//! How a fragment lies in memory: the members of `Fragment`, and the words of one entry, the key first.

use fragbuf_model::{Attribute, Format, Selection, Variant, mangled};
use fragbuf_templates::vocabulary::Order;

/// The members of a fragment and the words of a stored one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// What the first word is.
    pub key: Key,
    /// What a fragment carries, in the user's order; behind it what rows add.
    pub members: Vec<Member>,
    /// The words after the key, in memory order.
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

/// One member of `Fragment`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its name in generated code.
    pub name: String,
    /// How it is stored.
    pub format: Format,
    /// Where a pass over the scene has it from.
    pub source: Source,
}

/// Where a pass over the scene has a member from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The rasteriser's depth.
    Depth,
    /// A vertex input.
    Vertex,
    /// A WGSL built-in of fragment shaders, of type `u32`.
    BuiltIn(String),
}

/// One word beside the key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// Its field in `Packed`.
    pub field: String,
    /// The member that it holds, or a part of.
    pub member: Member,
    /// The components that it holds, for a vector of several words.
    pub components: Option<&'static str>,
}

impl Layout {
    /// The layout of a variant's payload with what the chosen rows add: words in the user's order, depth as the key unless
    /// there is a criterion. The attribute that decides ties comes first, so that the order of words is the order of
    /// fragments.
    pub fn of(variant: &Variant, selection: &Selection) -> Self {
        let key = if variant.criterion.is_some() { Key::Criterion } else { Key::Depth };
        let members: Vec<Member> = variant.attributes.iter().map(member).chain(carried(selection)).collect();
        let mut beside: Vec<Word> = Vec::new();
        let first = tie_breaker(selection).and_then(|index| members.get(index));
        let others = members.iter().filter(|member| Some(*member) != first);
        for member in first.into_iter().chain(others) {
            if key == Key::Depth && member.source == Source::Depth {
                continue;
            }
            for part in parts(member.format) {
                let suffix = part.map_or(String::new(), |letters| format!("_{letters}"));
                let name = format!("{}{suffix}", member.name);
                beside.push(Word { field: unused(name, &beside), member: member.clone(), components: part });
            }
        }
        Layout { key, members, beside }
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
        let depth = self.beside.iter().find(|word| word.member.source == Source::Depth);
        depth.map_or("key", |word| &word.field)
    }
}

fn member(attribute: &Attribute) -> Member {
    let source = if attribute.name.value == "depth" { Source::Depth } else { Source::Vertex };
    Member { name: mangled(&attribute.name.value).into_owned(), format: attribute.format.value, source }
}

fn carried(selection: &Selection) -> impl Iterator<Item = Member> {
    let carried = selection.rows.iter().flat_map(|selected| &selected.row.carries);
    carried.map(|word| Member {
        name: word.name.to_string(),
        format: Format::U32,
        source: Source::BuiltIn(word.built_in.to_string()),
    })
}

/// The attribute that decides between fragments with equal keys before all others, if the description names one.
fn tie_breaker(selection: &Selection) -> Option<usize> {
    let ties = selection.rows.iter().find(|selected| selected.row.order == Some(Order::Attribute))?;
    Some(ties.options.first().map_or(0, |(_, index)| *index as usize))
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
