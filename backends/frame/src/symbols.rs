//! Values of the symbols in a plan's formulas: those of generation come from the plan, those of allocation from the
//! frame's size, `k` from the caller, and the rest from host steps or from what was reserved.

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::Formula;

use crate::{Error, Sizing};

/// The values at one moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbols {
    /// Pixels of a row.
    pub width: u32,
    /// Rows of the whole frame.
    pub height: u32,
    /// Rows of a slice: `height` in formulas and shaders, which see one slice at a time.
    pub rows: u32,
    /// Fragments that a pixel keeps; `None` where it keeps all.
    pub k: Option<u32>,
    /// What host steps set, or what was reserved; `None`: [`Sizing::AUTO_PER_PIXEL`].
    pub counted: Vec<(String, Option<u64>)>,
}

/// Symbols that are bound when the frame is allocated or later, other than the counted ones.
const KNOWN: [&str; 7] = ["width", "height", "first_row", "pixels", "k", "n", "iteration"];

impl Symbols {
    /// The value of a symbol; `None`: nobody binds it.
    pub fn value(&self, plan: &Plan, symbol: &str) -> Option<u64> {
        match symbol {
            "width" => Some(self.width.into()),
            "height" => Some(self.rows.into()),
            "pixels" => plan.pixels().evaluate(&|symbol| self.value(plan, symbol)).ok(),
            "k" => self.k.map(u64::from),
            // Slots of a pixel where every pixel has as many: the room for fragments, shared out.
            "n" => self.counted(FRAGMENTS).map(|fragments| fragments.div_ceil(self.pixels().max(1))),
            _ => plan.bound.value(symbol).or_else(|| self.counted(symbol)),
        }
    }

    /// Pixels of a slice, its padding apart.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.rows)
    }

    /// What host steps set, or what is reserved.
    pub fn counted(&self, symbol: &str) -> Option<u64> {
        let (_, value) = self.counted.iter().find(|(name, _)| name == symbol)?;
        Some(value.unwrap_or(self.pixels() * u64::from(Sizing::AUTO_PER_PIXEL)))
    }

    /// Binds a symbol.
    pub fn set(&mut self, symbol: &str, value: u64) {
        self.counted.retain(|(name, _)| name != symbol);
        self.counted.push((symbol.to_owned(), Some(value)));
    }

    /// The value of a formula, which is `what`.
    pub fn evaluate(&self, plan: &Plan, formula: &Formula, what: &str) -> Result<u64, Error> {
        let value = formula.evaluate(&|symbol| self.value(plan, symbol));
        value.map_err(|error| Error::Formula { what: what.to_owned(), error })
    }

    /// Slices of the frame, from the top.
    pub fn slices(&self) -> u32 {
        self.height.div_ceil(self.rows.max(1))
    }

    /// Room, in fragments, after a frame that lost `short` of them for want of it: exactly enough where a pool was too small,
    /// twice as much where every pixel has slots of its own and only the deepest ran out.
    pub fn room_after(&self, plan: &Plan, short: u32) -> u64 {
        let now = self.value(plan, FRAGMENTS).unwrap_or(0);
        if plan.frame.iter().any(|field| field == "n") { (2 * now).max(self.pixels()) } else { now + u64::from(short) }
    }

    /// The uniform buffer of one slice and round: one word per field of the plan.
    pub fn frame_words(&self, plan: &Plan, slice: u32, round: u32) -> Result<Vec<u32>, Error> {
        let words = plan.frame.iter().map(|field| {
            let value = match field.as_str() {
                "iteration" => u64::from(round),
                "first_row" => u64::from(slice) * u64::from(self.rows),
                _ => self.value(plan, field).unwrap_or(0),
            };
            u32::try_from(value).map_err(|_| Error::TooLarge {
                what: format!("`{field}`"),
                needed: value,
                limit: u32::MAX.into(),
                limit_name: "a word of the frame's uniform buffer",
                hint: "take a smaller frame, or split it",
            })
        });
        words.collect()
    }
}

/// The symbol of the fragments that there is room for.
const FRAGMENTS: &str = "fragments";

/// The counted symbols of a plan: fields of the frame that neither the size nor the caller binds. Slots per pixel stand for
/// the fragments of the frame.
pub(crate) fn counted_symbols(plan: &Plan) -> Vec<String> {
    let named = plan.frame.iter().filter(|field| !KNOWN.contains(&field.as_str())).cloned();
    let slots = plan.frame.iter().any(|field| field == "n").then(|| FRAGMENTS.to_owned());
    named.chain(slots).collect()
}
