//! Generates the fragment: its attributes (`Fragment`), its words in memory (`Packed`), packing and unpacking, the two orders and the
//! constraints.

use std::fmt::Write;

use fragbuf_model::Format;
use fragbuf_templates::vocabulary::{Pass, TieBreak};

use super::effect;
use crate::Plan;
use crate::layout::{Key, Layout, MemberSource, Word};

pub(super) fn text(plan: &Plan, pass: &Pass) -> String {
    let mut text = String::new();
    structs(plan, &mut text);
    pack(plan, &mut text);
    unpack(plan, &mut text);
    words(plan, &mut text);
    recolored(plan, &mut text);
    orders(plan, &mut text);
    admit(plan, &mut text);
    effect::text(plan, pass, &mut text);
    text
}

fn structs(plan: &Plan, text: &mut String) {
    text.push_str("/// The attributes of a fragment.\nstruct Fragment {\n");
    for member in &plan.layout.members {
        let _ = writeln!(text, "    {}: {},", member.name, member.format.wgsl_type());
    }
    text.push_str("}\n\n/// The words of a fragment in memory. The smallest `key` is the best: ");
    text.push_str(match plan.layout.key {
        Key::Depth => "it stores the bits of the depth.\n",
        Key::Criterion => "it stores the ordered bits\n/// of the criterion.\n",
    });
    text.push_str("struct Packed {\n    key: u32,\n");
    for word in &plan.layout.values {
        let _ = writeln!(text, "    {}: u32,", word.field);
    }
    text.push_str("}\n\n");
}

fn pack(plan: &Plan, text: &mut String) {
    let key = match plan.layout.key {
        Key::Depth => "depth_bits(fragment.depth)",
        Key::Criterion => "ordered_bits(user_criterion(fragment))",
    };
    let values = plan.layout.values.iter().map(|word| packed(word, &format!("fragment.{}", word.member.name)));
    let fields = std::iter::once(key.to_owned()).chain(values);
    let _ = writeln!(text, "fn fragment_pack(fragment: Fragment) -> Packed {{");
    let _ = writeln!(text, "    return {};\n}}\n", construct("Packed", fields));
}

/// Returns a constructor call, with one field per line if there are more than two.
pub(super) fn construct(name: &str, fields: impl Iterator<Item = String>) -> String {
    let fields: Vec<String> = fields.collect();
    match fields.len() {
        0..=2 => format!("{name}({})", fields.join(", ")),
        _ => format!("{name}(\n        {},\n    )", fields.join(",\n        ")),
    }
}

/// Returns the expression that packs a word of a member's `value`.
fn packed(word: &Word, value: &str) -> String {
    match (word.member.format, word.components) {
        (Format::Rgba16, Some(pair)) => format!("pack2x16unorm({value}.{pair})"),
        (_, Some(component)) => format!("bitcast<u32>({value}.{component})"),
        (Format::F32, None) if word.member.source == MemberSource::Depth => format!("depth_bits({value})"),
        (Format::U32, None) => value.to_owned(),
        (Format::Rgba8, None) => format!("pack4x8unorm({value})"),
        (Format::Octahedral, None) => format!("octahedral_pack({value})"),
        (_, None) => format!("bitcast<u32>({value})"),
    }
}

/// The member that effects blend.
const COLOR: &str = "color";

/// Generates the function that changes the colour of an entry. The other words keep their bits.
fn recolored(plan: &Plan, text: &mut String) {
    let words = plan.layout.values.iter().filter(|word| word.member.name == COLOR);
    let changes: String =
        words.map(|word| format!("    changed.{} = {};\n", word.field, packed(word, "color"))).collect();
    let Some(color) = plan.layout.members.iter().find(|member| member.name == COLOR) else { return };
    let kind = color.format.wgsl_type();
    let _ = writeln!(
        text,
        "/// Returns the entry with another colour.\nfn packed_recolored(entry: Packed, color: {kind}) -> Packed {{\n    var changed = entry;\n{changes}    return changed;\n}}\n"
    );
}

fn unpack(plan: &Plan, text: &mut String) {
    let fields = plan.layout.members.iter().map(|member| {
        let fields: Vec<String> = if plan.layout.key == Key::Depth && member.source == MemberSource::Depth {
            vec!["entry.key".to_owned()]
        } else {
            let words = plan.layout.values.iter().filter(|word| word.member == *member);
            words.map(|word| format!("entry.{}", word.field)).collect()
        };
        unpacked(member.format, &fields)
    });
    let _ = writeln!(text, "fn fragment_unpack(entry: Packed) -> Fragment {{");
    let _ = writeln!(text, "    return {};\n}}\n", construct("Fragment", fields));
}

fn unpacked(format: Format, fields: &[String]) -> String {
    let each =
        |function: &str| fields.iter().map(|field| format!("{function}({field})")).collect::<Vec<_>>().join(", ");
    let floats = || each("bitcast<f32>");
    match format {
        Format::F32 => floats(),
        Format::U32 => fields.join(""),
        Format::Rgba8 => format!("unpack4x8unorm({})", fields.join("")),
        Format::Rgba16 => format!("{}({})", format.wgsl_type(), each("unpack2x16unorm")),
        Format::Octahedral => format!("octahedral_unpack({})", fields.join("")),
        Format::Vec2 | Format::Vec3 | Format::Vec4 => format!("{}({})", format.wgsl_type(), floats()),
    }
}

/// Generates access to value words by number, for storages that process them one by one.
fn words(plan: &Plan, text: &mut String) {
    let fields: Vec<&str> = plan.layout.values.iter().map(|word| word.field.as_str()).collect();
    let cases = |case: &dyn Fn(&str) -> String| -> String {
        (0..)
            .zip(&fields)
            .map(|(number, field)| format!("        case {number}u: {{\n            {}\n        }}\n", case(field)))
            .collect()
    };
    let read = cases(&|field| format!("return entry.{field};"));
    let _ = writeln!(
        text,
        "/// Returns a value word by its number.\nfn packed_word(entry: Packed, word: u32) -> u32 {{\n    switch word {{\n{read}        default: {{\n            return 0u;\n        }}\n    }}\n}}\n"
    );
    let written = cases(&|field| format!("changed.{field} = value;"));
    let _ = writeln!(
        text,
        "fn packed_with(entry: Packed, word: u32, value: u32) -> Packed {{\n    var changed = entry;\n    switch word {{\n{written}        default: {{}}\n    }}\n    return changed;\n}}\n"
    );
    let zeros = std::iter::once("key".to_owned()).chain(fields.iter().map(|_| "0u".to_owned()));
    let _ = writeln!(text, "fn packed_of_key(key: u32) -> Packed {{\n    return {};\n}}\n", construct("Packed", zeros));
}

fn orders(plan: &Plan, text: &mut String) {
    let order = plan.selection.rows.iter().find_map(|selected| selected.row.order);
    let words = match order {
        Some(TieBreak::Unordered | TieBreak::Submission) => vec!["key"],
        Some(TieBreak::Payload | TieBreak::Attribute) | None => keep_order(&plan.layout),
    };
    text.push_str("/// Tests whether `a` is better than `b`: the smaller key");
    text.push_str(if words.len() > 1 { ", then the smaller words.\n" } else { ".\n" });
    less("better", &words, text);
    text.push_str("/// Tests whether `a` is resolved before `b`: nearest first.\n");
    let nearer = match order {
        // The storage returns them in submission order, and the sort keeps this order.
        Some(TieBreak::Submission) => vec![plan.layout.depth_field()],
        _ => resolve_order(&plan.layout),
    };
    less("nearer", &nearer, text);
}

fn keep_order(layout: &Layout) -> Vec<&str> {
    std::iter::once("key").chain(layout.values.iter().map(|word| word.field.as_str())).collect()
}

/// Returns depth, then the payload, then the key: a total order on entries.
fn resolve_order(layout: &Layout) -> Vec<&str> {
    let depth = layout.depth_field();
    let others = keep_order(layout).into_iter().filter(|field| *field != depth && *field != "key");
    let key = (depth != "key").then_some("key");
    std::iter::once(depth).chain(others).chain(key).collect()
}

/// Generates the lexicographic order over `words`.
fn less(name: &str, words: &[&str], text: &mut String) {
    let _ = writeln!(text, "fn {name}(a: Packed, b: Packed) -> bool {{");
    if let Some((last, first)) = words.split_last() {
        for word in first {
            let _ = writeln!(text, "    if a.{word} != b.{word} {{\n        return a.{word} < b.{word};\n    }}");
        }
        let _ = writeln!(text, "    return a.{last} < b.{last};");
    }
    text.push_str("}\n\n");
}

fn admit(plan: &Plan, text: &mut String) {
    let calls: Vec<String> = plan.variant.constraints.iter().map(|c| format!("{}(fragment)", c.name)).collect();
    let condition = if calls.is_empty() { "true".to_owned() } else { calls.join(" && ") };
    text.push_str("/// Tests whether a fragment meets every constraint.\n");
    let _ = writeln!(text, "fn admit(fragment: Fragment) -> bool {{\n    return {condition};\n}}\n");
}
