//! The table of symbols of formulas. Plans, manifests, bindings, devices, the checker and row headers of users' files
//! use it.
//!
//! Parameters of the chosen rows are symbols too, by their constants (`PAGE_ENTRIES`); a plan adds them. The table has
//! no values: a description, a plan or a frame gives them.

use super::formula::is_function;
use super::{Formula, KEY_SYMBOLS};

/// A symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// The name in formulas, and of the field in the shaders' `frame`.
    pub name: &'static str,
    /// The meaning, in one line.
    pub meaning: &'static str,
    /// When the value is set.
    pub when: BindingTime,
    /// What sets the value.
    pub set_by: Setter,
    /// The default value, over other symbols.
    pub default: Option<&'static str>,
    /// The least and the greatest value.
    pub range: (u64, u64),
}

/// When the value of a symbol is set, the earliest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BindingTime {
    /// In the description. Conditions of rows use these symbols. A number in every generated file.
    Description,
    /// When code is generated. A number in every generated file.
    Generation,
    /// When memory is allocated for a frame's size.
    Allocation,
    /// Before a frame, without a new allocation, up to the allocated size.
    Frame,
    /// Inside a frame, by a host step; before it, the value that the caller reserves memory for.
    Readback,
    /// In every iteration of a loop, or in every slice.
    Iteration,
}

/// What sets the value of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setter {
    /// The description, through the plan.
    Description,
    /// Only the caller.
    Caller,
    /// The caller, or a host step of the plan.
    Host,
    /// The device that runs the frame.
    Device,
}

impl BindingTime {
    /// Returns the name in manifests.
    pub fn name(self) -> &'static str {
        match self {
            BindingTime::Description => "description",
            BindingTime::Generation => "generation",
            BindingTime::Allocation => "allocation",
            BindingTime::Frame => "frame",
            BindingTime::Readback => "readback",
            BindingTime::Iteration => "iteration",
        }
    }
}

impl Setter {
    /// Returns the name in manifests.
    pub fn name(self) -> &'static str {
        match self {
            Setter::Description => "description",
            Setter::Caller => "caller",
            Setter::Host => "host",
            Setter::Device => "device",
        }
    }
}

impl Symbol {
    /// Returns the default as a formula.
    pub fn default_formula(&self) -> Option<Formula> {
        self.default.map(Formula::from)
    }
}

/// The greatest value of a word of the shaders' uniform block.
const WORD: u64 = u32::MAX as u64;

/// The symbols of every plan, in the order of the fields of the shaders' `frame`.
pub const SYMBOLS: [Symbol; 19] = [
    symbol("width", "columns of the frame", BindingTime::Allocation, Setter::Caller, (1, WORD)),
    symbol("height", "rows of the frame or slice", BindingTime::Allocation, Setter::Caller, (1, WORD)),
    symbol("first_row", "the first row of a slice of the frame", BindingTime::Iteration, Setter::Device, (0, WORD)),
    Symbol {
        default: Some("width * height"),
        ..symbol(
            "pixels",
            "pixels of the frame, including the padding of the addressing",
            BindingTime::Allocation,
            Setter::Description,
            (1, WORD),
        )
    },
    symbol("k", "fragments that a pixel keeps, at most `capacity`", BindingTime::Frame, Setter::Host, (1, WORD)),
    Symbol {
        default: Some("ceil_div(fragments, width * height)"),
        ..symbol("n", "slots per pixel of a fixed array", BindingTime::Readback, Setter::Host, (0, WORD))
    },
    symbol("fragments", "fragments that the pool has memory for", BindingTime::Readback, Setter::Host, (0, WORD)),
    symbol("kept", "fragments that exact regions have memory for", BindingTime::Readback, Setter::Host, (0, WORD)),
    symbol(
        "iteration",
        "the iteration of the innermost loop, from 0",
        BindingTime::Iteration,
        Setter::Device,
        (0, WORD),
    ),
    symbol(
        "capacity",
        "the greatest k that the generated code supports",
        BindingTime::Generation,
        Setter::Description,
        (1, WORD),
    ),
    described("keep", "the number on the `keep` line; 2^32 for `keep all`", (1, WORD + 1)),
    described("limited", "1 if the description limits the fragments kept; 0 for `keep all`", (0, 1)),
    described("payload_words", "32-bit words of the payload, including depth and the words that rows add", (1, WORD)),
    described("entry_words", "32-bit words of a stored fragment: the payload, and the word of a criterion", (1, WORD)),
    described("value_words", "words of a stored fragment without the key", (0, WORD)),
    described("depth_key", "1 if depth is the key; 0 with a criterion", (0, 1)),
    described("color", "1 if the payload has a `color` of format rgba8, rgba16 or vec4; else 0", (0, 1)),
    described(
        "resumable",
        "1 if the effect is a closure that can be interrupted between two fragments; else 0",
        (0, 1),
    ),
    described(
        "resumed_words",
        "words that the effect keeps between the iterations of peeling: those of a closure's variables, 4 of a named effect",
        (0, WORD),
    ),
];

/// Returns whether a name has a meaning in every formula, so that no constant of a row can have it.
pub fn is_reserved_in_formulas(name: &str) -> bool {
    is_function(name) || KEY_SYMBOLS.contains(&name) || SYMBOLS.iter().any(|symbol| symbol.name == name)
}

const fn described(name: &'static str, meaning: &'static str, range: (u64, u64)) -> Symbol {
    symbol(name, meaning, BindingTime::Description, Setter::Description, range)
}

const fn symbol(
    name: &'static str,
    meaning: &'static str,
    when: BindingTime,
    set_by: Setter,
    range: (u64, u64),
) -> Symbol {
    Symbol { name, meaning, when, set_by, default: None, range }
}
