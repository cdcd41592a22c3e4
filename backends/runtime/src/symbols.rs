//! Values of the symbols in a plan's formulas: those of generation come from the plan, those of allocation from the
//! frame's size, `k` from the caller, and the rest from host steps or from what was reserved.

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::Formula;

use crate::Error;

/// The values at one moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Symbols {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Fragments that a pixel keeps; `None` where it keeps all.
    pub(crate) k: Option<u32>,
    /// What host steps set, or what was reserved.
    pub(crate) counted: Vec<(String, u64)>,
}

/// Symbols that are bound when the frame is allocated or later, other than the counted ones.
const KNOWN: [&str; 5] = ["width", "height", "pixels", "k", "iteration"];

impl Symbols {
    pub(crate) fn value(&self, plan: &Plan, symbol: &str) -> Option<u64> {
        match symbol {
            "width" => Some(self.width.into()),
            "height" => Some(self.height.into()),
            "pixels" => Some(self.pixels()),
            "k" => self.k.map(u64::from),
            _ => plan.bound.value(symbol).or_else(|| self.counted(symbol)),
        }
    }

    pub(crate) fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    pub(crate) fn counted(&self, symbol: &str) -> Option<u64> {
        self.counted.iter().find(|(name, _)| name == symbol).map(|(_, value)| *value)
    }

    pub(crate) fn set(&mut self, symbol: &str, value: u64) {
        self.counted.retain(|(name, _)| name != symbol);
        self.counted.push((symbol.to_owned(), value));
    }

    pub(crate) fn evaluate(&self, plan: &Plan, formula: &Formula, what: &str) -> Result<u64, Error> {
        let value = formula.evaluate(&|symbol| self.value(plan, symbol));
        value.map_err(|error| Error::Formula { what: what.to_owned(), error })
    }

    /// The frame's uniform buffer: one word per field of the plan.
    pub(crate) fn frame_words(&self, plan: &Plan) -> Result<Vec<u32>, Error> {
        let words = plan.frame.iter().map(|field| {
            let value = self.value(plan, field).unwrap_or(0);
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

/// The counted symbols of a plan: fields of the frame that neither the size nor the caller binds.
pub(crate) fn counted_symbols(plan: &Plan) -> Vec<String> {
    plan.frame.iter().filter(|field| !KNOWN.contains(&field.as_str())).cloned().collect()
}
