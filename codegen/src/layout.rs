//! The memory layout of a fragment: the members of `Fragment`, and the words of an entry, key first.

use fragbuf_model::{Attribute, AttributeSource, Format, Selection, Variant, mangled};
use fragbuf_templates::vocabulary::TieBreak;

/// The members of a fragment and the words of an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The meaning of the first word.
    pub key: Key,
    /// The payload, in the order of the description, then the attributes that rows add.
    pub members: Vec<Member>,
    /// The words after the key, in memory order.
    pub values: Vec<Word>,
}

/// The order by which the worst fragment is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// The bits of the depth. The depth is part of the payload, so the key needs no extra word.
    Depth,
    /// The ordered bits of the criterion's value: one word in addition to the payload.
    Criterion,
}

/// One member of `Fragment`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its name in generated code.
    pub name: String,
    /// Its format in memory.
    pub format: Format,
    /// Where geometry passes get its value.
    pub source: MemberSource,
}

/// Where geometry passes get the value of a member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MemberSource {
    /// The rasterised depth.
    Depth,
    /// 1 for the front side of a triangle, 0 for its back side.
    FrontFacing,
    /// A vertex input.
    Vertex,
    /// A WGSL built-in of fragment shaders, of type `u32`.
    BuiltIn(String),
}

/// A value word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// Its field in `Packed`.
    pub field: String,
    /// The member that it stores completely or partly.
    pub member: Member,
    /// The components that it stores, for a vector of several words.
    pub components: Option<&'static str>,
}

impl Layout {
    /// Returns the layout of a variant's payload and of the attributes that the selected rows add. Words are in the order of the
    /// description. Depth is the key unless there is a criterion. The attribute that breaks ties comes first, so that the order of
    /// words is the order of fragments.
    pub fn of(variant: &Variant, selection: &Selection) -> Self {
        let key = if variant.criterion.is_some() { Key::Criterion } else { Key::Depth };
        let members: Vec<Member> = variant.attributes.iter().map(member).chain(implicit_members(selection)).collect();
        let mut values: Vec<Word> = Vec::new();
        let first = tie_breaker(selection).and_then(|index| members.get(index));
        let others = members.iter().filter(|member| Some(*member) != first);
        for member in first.into_iter().chain(others) {
            if key == Key::Depth && member.source == MemberSource::Depth {
                continue;
            }
            for part in parts(member.format) {
                let suffix = part.map_or(String::new(), |letters| format!("_{letters}"));
                let name = format!("{}{suffix}", member.name);
                values.push(Word { field: unused(name, &values), member: member.clone(), components: part });
            }
        }
        Layout { key, members, values }
    }

    /// Returns the words of an entry, including the key.
    pub fn entry_words(&self) -> u32 {
        self.value_words() + 1
    }

    /// Returns the words of an entry after the key.
    pub fn value_words(&self) -> u32 {
        self.values.len() as u32
    }

    /// Returns the field that stores the depth.
    pub fn depth_field(&self) -> &str {
        let depth = self.values.iter().find(|word| word.member.source == MemberSource::Depth);
        depth.map_or("key", |word| &word.field)
    }
}

fn member(attribute: &Attribute) -> Member {
    let source = match attribute.source() {
        AttributeSource::Depth => MemberSource::Depth,
        AttributeSource::FrontFacing => MemberSource::FrontFacing,
        AttributeSource::Vertex => MemberSource::Vertex,
    };
    Member { name: mangled(&attribute.name.value).into_owned(), format: attribute.format.value, source }
}

fn implicit_members(selection: &Selection) -> impl Iterator<Item = Member> {
    let words = selection.rows.iter().flat_map(|selected| &selected.row.extra_words);
    words.map(|word| Member {
        name: word.name.to_string(),
        format: Format::U32,
        source: MemberSource::BuiltIn(word.built_in.to_string()),
    })
}

/// Returns the attribute that breaks ties first, if the description names one.
fn tie_breaker(selection: &Selection) -> Option<usize> {
    let ties = selection.rows.iter().find(|selected| selected.row.order == Some(TieBreak::Attribute))?;
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

/// Returns `name` with `_` appended until neither the key nor another word has this name.
fn unused(mut name: String, words: &[Word]) -> String {
    while name == "key" || words.iter().any(|word| word.field == name) {
        name.push('_');
    }
    name
}
