//! What the host decides between two submissions: a table of functions, by the names that plans give them.
//!
//! In: the words that a step reads back. Out: values of the symbols that it sets. Nothing is allocated here.

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::{Formula, Host};

use crate::{Error, Symbols, resource, unsupported};

/// One host function: from the words read, in the order of `reads`, to the values set, in the order of `sets`.
type Function = fn(&[u32]) -> Vec<u64>;

/// Every host function that there is.
const FUNCTIONS: [(&str, Function); 1] = [("allocate", allocate)];

/// Room for as many as were counted.
fn allocate(words: &[u32]) -> Vec<u64> {
    words.iter().map(|word| u64::from(*word)).collect()
}

/// One host step of a plan.
#[derive(Clone, Debug)]
pub struct Decision {
    function: Function,
    /// Words to read back: the resource and its index in words.
    pub reads: Vec<(usize, Formula)>,
    sets: Vec<String>,
}

impl Decision {
    /// What a host step says. `Err`: a function that nobody here has.
    pub fn of(host: &Host, plan: &Plan) -> Result<Self, Error> {
        let function = FUNCTIONS.iter().find(|(name, _)| *name == host.function);
        let (_, function) = function.ok_or_else(|| unsupported(format!("the host function `{}`", host.function)))?;
        let reads = host.reads.iter().map(|read| {
            // `offsets[pixels]`: one word; a name alone: the first.
            let (name, place) = read.split_once('[').unwrap_or((read, "0]"));
            let place = place.strip_suffix(']').ok_or_else(|| unsupported(format!("the readback of `{read}`")))?;
            Ok((resource(plan, name)?, Formula::from(place.to_owned())))
        });
        Ok(Decision { function: *function, reads: reads.collect::<Result<_, Error>>()?, sets: host.sets.clone() })
    }

    /// The symbols with what was read put in.
    pub fn apply(&self, words: &[u32], symbols: &mut Symbols) {
        for (name, value) in self.sets.iter().zip((self.function)(words)) {
            symbols.set(name, value);
        }
    }
}
