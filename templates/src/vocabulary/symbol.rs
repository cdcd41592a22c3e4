//! The symbols of formulas: one table, read by plans, manifests, bindings, devices, the checker and rows in users' files.
//!
//! Parameters of the chosen rows are symbols too, by their constants (`PAGE_ENTRIES`); a plan adds them to these. Nothing
//! here has a value: values belong to a description, to a plan or to a frame.

use super::Formula;

/// One symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// The word in formulas, and the field's name in the shaders' `frame`.
    pub name: &'static str,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// When it gets its value.
    pub when: When,
    /// Who gives it its value.
    pub set_by: SetBy,
    /// The value where nobody sets one, over other symbols.
    pub default: Option<&'static str>,
    /// The least and the greatest value.
    pub range: (u64, u64),
}

/// When a symbol gets its value, the earliest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum When {
    /// By the description alone: what the conditions of rows are over. A number in every text.
    Description,
    /// When code is generated: a number in every text.
    Generation,
    /// When memory is allocated for a frame's size.
    Allocation,
    /// Before a frame, without new memory, up to what memory was allocated for.
    Frame,
    /// Inside a frame, by a host step; before that, what the caller reserves.
    Readback,
    /// Anew in every iteration of a loop, or in every slice.
    Round,
}

/// Who gives a symbol its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetBy {
    /// The description, through the plan.
    Description,
    /// The caller alone.
    Caller,
    /// The caller, or a host step of the plan.
    Host,
    /// The device that runs the frame.
    Device,
}

impl When {
    /// The word of manifests.
    pub fn word(self) -> &'static str {
        match self {
            When::Description => "description",
            When::Generation => "generation",
            When::Allocation => "allocation",
            When::Frame => "frame",
            When::Readback => "readback",
            When::Round => "round",
        }
    }
}

impl SetBy {
    /// The word of manifests.
    pub fn word(self) -> &'static str {
        match self {
            SetBy::Description => "description",
            SetBy::Caller => "caller",
            SetBy::Host => "host",
            SetBy::Device => "device",
        }
    }
}

impl Symbol {
    /// The default, as a formula.
    pub fn default_formula(&self) -> Option<Formula> {
        self.default.map(Formula::from)
    }
}

/// A word of the shaders' uniform block.
const WORD: u64 = u32::MAX as u64;

/// The symbols that every plan has, in the order in which the shaders' `frame` has those that it needs.
pub const SYMBOLS: [Symbol; 17] = [
    symbol("width", "columns of the frame", When::Allocation, SetBy::Caller, (1, WORD)),
    symbol("height", "rows of the frame; of a slice, its rows", When::Allocation, SetBy::Caller, (1, WORD)),
    symbol("first_row", "the row at which a slice of the picture begins", When::Round, SetBy::Device, (0, WORD)),
    Symbol {
        default: Some("width * height"),
        ..symbol(
            "pixels",
            "pixels of the frame and of the padding that the addressing adds",
            When::Allocation,
            SetBy::Description,
            (1, WORD),
        )
    },
    symbol("k", "fragments that a pixel keeps, up to `capacity`", When::Frame, SetBy::Host, (1, WORD)),
    Symbol {
        default: Some("ceil_div(fragments, width * height)"),
        ..symbol("n", "slots of every pixel of a fixed array", When::Readback, SetBy::Host, (0, WORD))
    },
    symbol("fragments", "fragments that a pool has memory for", When::Readback, SetBy::Host, (0, WORD)),
    symbol("kept", "fragments that exact regions have memory for", When::Readback, SetBy::Host, (0, WORD)),
    symbol("iteration", "the iteration of the innermost loop, from 0", When::Round, SetBy::Device, (0, WORD)),
    symbol("capacity", "the greatest k that the code serves", When::Generation, SetBy::Description, (1, WORD)),
    described(
        "keep",
        "the number on the `keep` line; for `keep all` more than any number that can be written there",
        (1, WORD + 1),
    ),
    described("limited", "1 where the description keeps no more than k fragments; 0 for `keep all`", (0, 1)),
    described("payload_words", "32-bit words of the payload, depth included, with those that rows add", (1, WORD)),
    described("entry_words", "32-bit words of a stored fragment: the payload, and a criterion's word", (1, WORD)),
    described("beside_words", "those words without the key", (0, WORD)),
    described("depth_key", "1 where depth decides which fragment is worst; 0 with a criterion", (0, 1)),
    described("color", "1 where the payload has a `color` of format rgba8, rgba16 or vec4; else 0", (0, 1)),
];

const fn described(name: &'static str, meaning: &'static str, range: (u64, u64)) -> Symbol {
    symbol(name, meaning, When::Description, SetBy::Description, range)
}

const fn symbol(name: &'static str, meaning: &'static str, when: When, set_by: SetBy, range: (u64, u64)) -> Symbol {
    Symbol { name, meaning, when, set_by, default: None, range }
}
