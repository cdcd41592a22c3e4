//! The payload: what closures see (`Fragment`), what memory holds (`Packed`), the way from one to the other, the two
//! orders, and the constraints.

use std::fmt::Write;

use fragbuf_model::Format;
use fragbuf_templates::vocabulary::Order;

use crate::Plan;
use crate::layout::{Key, Layout, Source, Word};

pub(super) fn text(plan: &Plan) -> String {
    let mut text = String::new();
    structs(plan, &mut text);
    pack(plan, &mut text);
    unpack(plan, &mut text);
    words(plan, &mut text);
    recolored(plan, &mut text);
    orders(plan, &mut text);
    admit(plan, &mut text);
    if plan.variant.resolve.is_some() {
        text.push_str("fn resolve_layers() -> vec4<f32> {\n    return user_resolve();\n}\n");
    }
    text
}

fn structs(plan: &Plan, text: &mut String) {
    text.push_str("/// What a fragment carries.\nstruct Fragment {\n");
    for member in &plan.layout.members {
        let _ = writeln!(text, "    {}: {},", member.name, member.format.wgsl_type());
    }
    text.push_str("}\n\n/// The same as words in memory. Fragments are ordered by `key`, the least is the best: ");
    text.push_str(match plan.layout.key {
        Key::Depth => "it holds the bits of the depth.\n",
        Key::Criterion => "it holds the ordered\n/// bits of the criterion.\n",
    });
    text.push_str("struct Packed {\n    key: u32,\n");
    for word in &plan.layout.beside {
        let _ = writeln!(text, "    {}: u32,", word.field);
    }
    text.push_str("}\n\n");
}

fn pack(plan: &Plan, text: &mut String) {
    let key = match plan.layout.key {
        Key::Depth => "depth_bits(fragment.depth)",
        Key::Criterion => "ordered_bits(user_criterion(fragment))",
    };
    let beside = plan.layout.beside.iter();
    let values = beside.map(|word| packed(word, &format!("fragment.{}", word.member.name)));
    let fields = std::iter::once(key.to_owned()).chain(values);
    let _ = writeln!(text, "fn fragment_pack(fragment: Fragment) -> Packed {{");
    let _ = writeln!(text, "    return {};\n}}\n", construct("Packed", fields));
}

/// A constructor call, one field a line where there are more than two.
pub(super) fn construct(name: &str, fields: impl Iterator<Item = String>) -> String {
    let fields: Vec<String> = fields.collect();
    match fields.len() {
        0..=2 => format!("{name}({})", fields.join(", ")),
        _ => format!("{name}(\n        {},\n    )", fields.join(",\n        ")),
    }
}

/// A word of a member's `value`.
fn packed(word: &Word, value: &str) -> String {
    match (word.member.format, word.components) {
        (Format::Rgba16, Some(pair)) => format!("pack2x16unorm({value}.{pair})"),
        (_, Some(component)) => format!("bitcast<u32>({value}.{component})"),
        (Format::F32, None) if word.member.source == Source::Depth => format!("depth_bits({value})"),
        (Format::U32, None) => value.to_owned(),
        (Format::Rgba8, None) => format!("pack4x8unorm({value})"),
        (Format::Octahedral, None) => format!("octahedral_pack({value})"),
        (_, None) => format!("bitcast<u32>({value})"),
    }
}

/// The member that effects blend.
const COLOR: &str = "color";

/// Another colour for an entry whose other words stay as they are, to the bit.
fn recolored(plan: &Plan, text: &mut String) {
    let words = plan.layout.beside.iter().filter(|word| word.member.name == COLOR);
    let changes: String =
        words.map(|word| format!("    changed.{} = {};\n", word.field, packed(word, "color"))).collect();
    let Some(color) = plan.layout.members.iter().find(|member| member.name == COLOR) else { return };
    let kind = color.format.wgsl_type();
    let _ = writeln!(
        text,
        "/// The same entry with another colour.\nfn packed_recolored(entry: Packed, color: {kind}) -> Packed {{\n    var changed = entry;\n{changes}    return changed;\n}}\n"
    );
}

fn unpack(plan: &Plan, text: &mut String) {
    let fields = plan.layout.members.iter().map(|member| {
        let fields: Vec<String> = if plan.layout.key == Key::Depth && member.source == Source::Depth {
            vec!["entry.key".to_owned()]
        } else {
            let words = plan.layout.beside.iter().filter(|word| word.member == *member);
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

/// Access to the words of an entry by number, for storages that handle them one by one.
fn words(plan: &Plan, text: &mut String) {
    let fields: Vec<&str> = plan.layout.beside.iter().map(|word| word.field.as_str()).collect();
    let cases = |case: &dyn Fn(&str) -> String| -> String {
        (0..)
            .zip(&fields)
            .map(|(number, field)| format!("        case {number}u: {{\n            {}\n        }}\n", case(field)))
            .collect()
    };
    let read = cases(&|field| format!("return entry.{field};"));
    let _ = writeln!(
        text,
        "/// A word beside the key, by its number.\nfn packed_word(entry: Packed, word: u32) -> u32 {{\n    switch word {{\n{read}        default: {{\n            return 0u;\n        }}\n    }}\n}}\n"
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
        Some(Order::Unordered | Order::Submission) => vec!["key"],
        Some(Order::Payload | Order::Attribute) | None => keep_order(&plan.layout),
    };
    text.push_str("/// Whether `a` is kept rather than `b`: the lesser key");
    text.push_str(if words.len() > 1 { ", of equal keys the lesser words.\n" } else { ".\n" });
    less("better", &words, text);
    text.push_str("/// Whether `a` comes before `b` when the kept fragments are resolved: nearest first.\n");
    let nearer = match order {
        // The storage gives them in the order of submission, and the sort leaves them there.
        Some(Order::Submission) => vec![plan.layout.depth_field()],
        _ => resolve_order(&plan.layout),
    };
    less("nearer", &nearer, text);
}

fn keep_order(layout: &Layout) -> Vec<&str> {
    std::iter::once("key").chain(layout.beside.iter().map(|word| word.field.as_str())).collect()
}

/// Depth, then the payload, then the key: a total order on entries.
fn resolve_order(layout: &Layout) -> Vec<&str> {
    let depth = layout.depth_field();
    let others = keep_order(layout).into_iter().filter(|field| *field != depth && *field != "key");
    let key = (depth != "key").then_some("key");
    std::iter::once(depth).chain(others).chain(key).collect()
}

/// The lexicographic order over `words`.
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
    text.push_str("/// Whether a fragment meets every constraint.\n");
    let _ = writeln!(text, "fn admit(fragment: Fragment) -> bool {{\n    return {condition};\n}}\n");
}
