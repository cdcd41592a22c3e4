//! The words that a device keeps where it ends loops and drops objects itself ([`Conditions::OnDevice`]), as GPUs do with conditional
//! rendering.

use std::collections::BTreeMap;

use fragbuf_codegen::{LoopId, PassId};
use fragbuf_frame::{Condition, ConditionWord, LOOP_WORDS};

use super::Frame;

/// The words of the loops and the dropped objects of a slice.
#[derive(Debug, Default)]
pub(super) struct ConditionWords {
    /// [`LOOP_WORDS`] of each loop, over all slices.
    pub(super) loops: Vec<u32>,
    /// The objects that each query has dropped, in this slice.
    pub(super) dropped: BTreeMap<PassId, Vec<bool>>,
}

impl ConditionWords {
    pub(super) fn new(loops: usize) -> Self {
        ConditionWords { loops: vec![0; LOOP_WORDS * loops], dropped: BTreeMap::new() }
    }

    /// Whether the passes of a loop draw; outside of loops, they do.
    pub(super) fn draws(&self, id: Option<LoopId>) -> bool {
        id.and_then(|LoopId(number)| self.loops.get(LOOP_WORDS * number)).is_none_or(|word| *word != 0)
    }
}

impl Frame<'_> {
    /// Updates the words.
    pub(super) fn update_conditions(&mut self, condition: Condition) {
        match condition {
            Condition::Begin { id, around } => {
                self.conditions.loops[LOOP_WORDS * id.0] = self.conditions.draws(around).into();
            }
            Condition::End { id, .. } if !self.conditions.draws(Some(id)) => {}
            Condition::End { id, word, is_last } => {
                let is_met = match word {
                    ConditionWord::Word(range) => self.words(range).iter().all(|word| *word == 0),
                    ConditionWord::Samples(PassId(pass)) => self.samples[pass] == 0,
                };
                if let Some([draws, iterations, is_cut]) = self.conditions.loops[LOOP_WORDS * id.0..].first_chunk_mut()
                {
                    *draws = u32::from(!is_met);
                    *iterations += 1;
                    *is_cut |= u32::from(is_last && !is_met);
                }
            }
            Condition::Objects { pass, around } => {
                let visible = std::mem::take(&mut self.objects);
                if self.conditions.draws(around) {
                    let dropped = self.conditions.dropped.entry(pass).or_default();
                    dropped.resize(dropped.len().max(visible.len()), false);
                    dropped.iter_mut().zip(visible).for_each(|(dropped, word)| *dropped |= word == 0);
                }
            }
        }
    }
}
