//! The fragments that an effect reads and its buffer does not keep.
//!
//! Input: the result of a rendering. Output: their number, for `--json` and for a warning that says what to change.

use fragbuf::vocabulary::Capability;
use fragbuf_model::counted;
use serde_json::{Value, json};

use super::Effect;
use crate::cli::output::warn;
use crate::cli::rendering::RenderResult;
use crate::cli::statistics::FragmentCounts;

/// What an effect reads, and what its buffer did not keep of it.
pub(crate) struct MissingFragments {
    effect: &'static Effect,
    /// k, if it is less than what the effect reads; `None`: the buffer keeps enough, whatever the scene.
    too_small: Option<u32>,
    /// The fragments that are not kept although the effect reads them; `None`: not counted.
    count: Option<u64>,
}

impl MissingFragments {
    pub(crate) fn of(effect: &'static Effect, result: &RenderResult) -> Self {
        let is_kept_later = result.plan.selection.provides().contains(&Capability::KeepsLater);
        let k = result.stats.k.or(result.plan.variant.keep).filter(|_| !is_kept_later);
        let too_small = k.filter(|k| effect.reads.is_none_or(|reads| *k < reads));
        let count = match too_small {
            None => Some(0),
            Some(_) => FragmentCounts::of(result).map(|counts| counts.rejected()),
        };
        MissingFragments { effect, too_small, count }
    }

    /// Prints a warning if fragments are missing.
    pub(crate) fn warn(&self, description: &str) {
        let Some(k) = self.too_small.filter(|_| self.count.is_none_or(|count| count > 0)) else { return };
        let read = match self.effect.reads {
            None => "all fragments".to_owned(),
            Some(reads) => format!("the {} nearest", counted(reads, "fragment")),
        };
        let missing = match self.count {
            Some(count) => format!("{} are not kept", counted(count, "fragment")),
            None => "the others are not counted".to_owned(),
        };
        let help = "raise k with `--set k=…`, or keep every fragment";
        warn(&format!(
            "{description}: the effect reads {read} of a pixel, and k = {k} is too small: {missing}; {help}"
        ));
    }

    pub(crate) fn json(&self) -> Value {
        json!({ "name": self.effect.name, "reads": self.effect.reads, "missing": self.count })
    }
}
