//! Peeling of fragments with equal depths by their ids.

use super::layers::{by_slot, joining, layers, slots};
use super::{accumulated, edits};
use crate::vocabulary::{
    Access, Capability, Compare, Condition, DepthState, Edit, Element, Feature, Pass, Resource, Row, Step, Template,
    TextureFormat, Use,
};

/// Peels fragments of equal depth by their ids, two at a time.
pub(super) fn id_pairs() -> Row {
    by_ids(
        ONE_SIDE,
        template!("peeling/id_pairs"),
        "id_pairs",
        "yes, until none is left: each iteration stores the least and the greatest id left in the nearest depth",
        "D13 §3.1.2, Alg. 1 (F2B-2P)",
    )
}

/// Peels layers, and fragments of equal depth by their ids where a layer has several.
pub(super) fn ids_on_demand() -> Row {
    let row = by_ids(
        ON_DEMAND,
        template!("peeling/ids_on_demand"),
        "ids_on_demand",
        "yes, until none is left: each iteration stores the nearest depth if one fragment has it, else as `id_pairs`",
        "D13 §5",
    );
    Row {
        // The first fragment of a layer is stored before it is known whether there are others: no pass can count it.
        requires: [row.requires.as_slice(), &[Capability::OnePerSlot]].concat(),
        edits: [edits(&["window", "found"], Vec::new()), vec![find_first_layer(), by_slot()]].concat(),
        ..row
    }
}

/// As [`id_pairs`], from the front and from the back.
pub(super) fn id_pairs_both_sides() -> Row {
    by_ids(
        BOTH_SIDES,
        template!("peeling/id_pairs_both_sides"),
        "id_pairs_both_sides",
        "yes, until none is left: as `id_pairs`, for the nearest and for the farthest depth",
        "D13 §3.1.2 (DUAL-2P)",
    )
}

/// As [`id_pairs`], behind a depth test: the first of three draws writes the depth of the layer.
pub(super) fn id_pairs_tested() -> Row {
    let depths = Resource::new(
        "layer_depths",
        Element::Texture(TextureFormat::Depth32Float),
        "the depth of the layer whose fragments are stored; 1: none",
    );
    let test = |compare: Compare, write: bool| DepthState {
        resource: "layer_depths".to_owned(),
        compare,
        write,
        early: !write,
    };
    // `FIND_IDS` is 0 in the draw that finds the layer.
    let find = |number: u32, name: &str, skeleton: &str, depth: DepthState| {
        let mut pass = Pass::geometry(name, skeleton).uses("layer_depths", Access::Attachment);
        pass.constants.push(("FIND_IDS".to_owned(), number));
        pass.state.depth = Some(depth);
        Step::Pass(pass)
    };
    let before = vec![
        find(0, "find_layer", "find_layer", test(Compare::LessEqual, true)),
        find(1, "find_ids", "find_in_layer", test(Compare::Equal, false)),
    ];
    let row = by_ids(
        ONE_SIDE,
        template!("peeling/id_pairs_tested"),
        "id_pairs_tested",
        "yes, until none is left: as `id_pairs`, after a draw that writes the depth of the layer",
        "D13 §3.1.2 (F2B-3P)",
    );
    Row {
        resources: [row.resources, vec![depths.by("pixel", "pixels").cleared(1.0_f32.to_bits())]].concat(),
        requires: [row.requires.as_slice(), &[Capability::CullInShader, Capability::SyncInShader]].concat(),
        needs: [row.needs.as_slice(), &[Feature::EarlyDepth, Feature::OwnEntryPoints]].concat(),
        edits: [
            vec![Edit::First(before), Edit::SetDepth("store".to_owned(), test(Compare::Equal, false))],
            edits(&["window", "found"], Vec::new()),
            vec![by_slot()],
        ]
        .concat(),
        ..row
    }
}

/// The sides; the slots of an iteration, two ids of each side; the words of what an iteration finds.
const ONE_SIDE: [&str; 3] = ["1", "2", "4"];
const ON_DEMAND: [&str; 3] = ["1", "2", "5"];
const BOTH_SIDES: [&str; 3] = ["2", "4", "4"];

/// Returns a row that peels by ids from this number of sides, with this number of slots.
fn by_ids(
    [sides, number_of_slots, found_words]: [&'static str; 3],
    template: Template,
    key: &str,
    summary: &'static str,
    paper: &'static str,
) -> Row {
    let words = |name: &str, words: &'static str, summary: &'static str| {
        let words = Resource::new(name, Element::Word, summary).by("word", words).by("side", sides);
        words.by("pixel", "pixels").cleared(u32::MAX)
    };
    let window =
        "the key of the layer; the ids between which its fragments are left, the greater inverted; EMPTY: all are";
    let found = "the key of the next layer; the least and the greatest id of this one, the latter inverted; 0: other ids are between";
    let find = Pass::geometry("find_ids", "find_in_layer");
    let row = layers(key, summary, paper);
    Row {
        template: Some(template),
        resources: [
            vec![words("window", "3", window).over_iterations(), words("found", found_words, found)],
            accumulated(),
        ]
        .concat(),
        uses: vec![Use::new("window", Access::Read), Use::rechecked("found"), Use::new("remaining", Access::Atomic)],
        provides: [row.provides.as_slice(), &[Capability::TellsIdsApart]].concat(),
        requires: [joining(&row).as_slice(), &[Capability::TotalOrder]].concat(),
        conditions: [row.conditions.as_slice(), &[has_values()]].concat(),
        constants: slots(number_of_slots),
        edits: [
            // Before a pass that counts what the storage needs.
            vec![Edit::First(vec![Step::Pass(find)])],
            edits(&["window", "found"], Vec::new()),
            vec![find_first_layer(), by_slot()],
        ]
        .concat(),
        ..row
    }
}

/// Finds the first layers before the loop.
fn find_first_layer() -> Edit {
    Edit::First(vec![Step::Pass(Pass::geometry("nearest_layer", "nearest_layer").uses_rechecked("window"))])
}

/// Requires a word of a fragment beside its key.
fn has_values() -> Condition {
    Condition::new(
        "value_words > 0",
        "an attribute besides the depth: its first word is the id",
        "add `id: u32` to the fragment, and `ties: attribute { by: id }`",
    )
}
