//! The counters of a frame, by name.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_follow::manifest::{Counter, Plan};

/// The counters of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counters {
    /// All counters.
    pub by_name: BTreeMap<String, u64>,
    /// The sum of the counters of lost fragments. If it is not 0, the image is or may be wrong.
    pub lost: u64,
}

/// The names of the words of the counters.
pub struct CounterNames {
    /// The name of the buffer.
    pub buffer: String,
    pub(super) plan: Arc<Plan>,
}

impl CounterNames {
    /// Names the counters of these words.
    pub fn counters(&self, bytes: &[u8]) -> Counters {
        let value = |counter: &Counter| {
            let word = bytes.chunks_exact(4).nth(counter.index).and_then(|word| word.try_into().ok());
            u64::from(word.map_or(0, u32::from_le_bytes))
        };
        let counters = || self.plan.counters.iter();
        Counters {
            by_name: counters().map(|counter| (counter.name.clone(), value(counter))).collect(),
            lost: counters().filter(|counter| counter.is_loss).map(value).sum(),
        }
    }
}
