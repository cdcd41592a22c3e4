//! Runs a fragment from one event to the next, and remembers where it stopped.
//!
//! Input: a stopped fragment and the reply to its event. Output: its next status. What a fragment does between two events depends
//! on nothing else, because all memory that others write is accessed by events. So each pair is run once per search.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash, Hasher};
use std::rc::Rc;

use fragbuf_interpreter::{Access, Event, Machine, Reply};

use crate::context::SearchContext;
use crate::fingerprint::{Identity, Lanes};
use crate::pausing::perform;
use crate::state::{Status, StepError};

/// A fragment that has stopped before an event.
#[derive(Debug)]
pub(crate) struct Stop {
    pub(crate) event: Event,
    /// The instruction.
    pub(crate) at: u32,
    /// The words from which a machine is restored. They determine the event.
    pub(crate) saved: Box<[u32]>,
    fingerprint: u128,
}

impl Stop {
    pub(crate) fn new(event: Event, at: u32, saved: Vec<u32>) -> Self {
        let mut lanes = Lanes::default();
        saved.hash(&mut lanes);
        Stop { event, at, saved: saved.into(), fingerprint: lanes.both() }
    }
}

impl PartialEq for Stop {
    fn eq(&self, other: &Self) -> bool {
        self.fingerprint == other.fingerprint && self.saved == other.saved
    }
}

impl Eq for Stop {}

impl Hash for Stop {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u128(self.fingerprint);
    }
}

/// A write whose order no program can observe: the index of its word in a state, and the access.
pub(crate) type CommutingWrite = (u32, Access);

/// What a fragment does from one event to the next.
struct Run {
    end: Result<Status, StepError>,
    commuting: Box<[CommutingWrite]>,
}

/// A machine, and the runs that are known.
pub(crate) struct Runner<'p> {
    machine: Machine<'p>,
    runs: HashMap<u128, Run, BuildHasherDefault<Identity>>,
}

/// The most runs that are remembered.
const MOST_RUNS: usize = 1 << 18;

impl<'p> Runner<'p> {
    /// Creates a runner for a search.
    pub(crate) fn new(context: &SearchContext<'p>) -> Self {
        Runner { machine: Machine::new(context.program), runs: HashMap::default() }
    }

    /// Runs a fragment from its event, which has this reply, to its next event.
    pub(crate) fn resume(
        &mut self,
        context: &SearchContext<'p>,
        fragment: usize,
        (stop, reply): (&Stop, Reply),
        words: &mut [u32],
    ) -> Result<Status, StepError> {
        let is_helper = context.helper == Some(fragment);
        let (kind, value) = match reply {
            Reply::Done(value) => (0, value),
            Reply::Failed(value) => (1, value),
            Reply::Stop => (2, 0),
        };
        let mut lanes = Lanes::default();
        stop.hash(&mut lanes);
        lanes.write_u64(value);
        // The address of an event in workgroup memory is that of the fragment's own workgroup.
        let workgroup = context.workgroups.get(fragment).copied().unwrap_or(0);
        lanes.write_u32(kind << 1 | u32::from(is_helper) | workgroup << 8);
        let key = lanes.both();
        if let Some(run) = self.runs.get(&key) {
            for (word, access) in &run.commuting {
                perform(access, &mut words[*word as usize..]);
            }
            return run.end.clone();
        }
        self.machine.load(&stop.saved);
        let mut commuting = Vec::new();
        let end = context.run(&mut self.machine, fragment, Some(reply), words, &mut commuting);
        if self.runs.len() < MOST_RUNS {
            self.runs.insert(key, Run { end: end.clone(), commuting: commuting.into() });
        }
        end
    }
}

impl Status {
    /// Returns the status of a fragment that has just stopped.
    pub(crate) fn before(stop: Stop) -> Self {
        Status::Before { stop: Rc::new(stop), anchor: None }
    }
}
