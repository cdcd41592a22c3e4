//! An axiomatic model: enumerates the executions of a small program, and returns the outcomes of the consistent ones.
//!
//! An execution assigns to every read the write that it observes (`rf`), and to every word an order of its writes (`mo`). It is
//! consistent if `mo`, `rf` and `fr` do not contradict happens-before, and a read-modify-write directly follows the write that
//! it observes. These are the axioms of RC11 (Lahav et al., PLDI 2017) and of the Vulkan memory model for relaxed atomic
//! operations and acquire-release fences of one scope. Nothing here is shared with the operational model.

use std::collections::BTreeSet;

use super::{Kind, Outcome, Program};

/// Events 0 and 1 are the initial writes of the two words, then come two of each invocation.
const EVENTS: usize = 6;

type Relation = [[bool; EVENTS]; EVENTS];

/// The outcomes of a program.
#[derive(Debug, Default)]
pub(super) struct Outcomes {
    /// Those of executions without a cycle of program order and reads-from.
    pub(super) ordered: BTreeSet<Outcome>,
    /// Those of all consistent executions.
    pub(super) all: BTreeSet<Outcome>,
}

/// One choice of what every event does.
#[derive(Clone, Debug)]
struct Execution<'a> {
    program: &'a Program,
    /// Per event, the write that it observes.
    rf: [Option<usize>; EVENTS],
    /// Per event, whether it is a compare-exchange that succeeds.
    exchanges: [bool; EVENTS],
    /// Per word, its writes in modification order.
    mo: [Vec<usize>; 2],
}

pub(super) fn outcomes(program: &Program) -> Outcomes {
    let mut outcomes = Outcomes::default();
    for success in 0..1 << EVENTS {
        let exchanges: [bool; EVENTS] = std::array::from_fn(|event| success >> event & 1 == 1);
        let is_exchange = |event: usize| event >= 2 && program.operations[event - 2].kind == Kind::CompareExchange;
        if (0..EVENTS).any(|event| exchanges[event] && !is_exchange(event)) {
            continue;
        }
        let base = Execution { program, rf: [None; EVENTS], exchanges, mo: [Vec::new(), Vec::new()] };
        for mo_x in orders(&base.writes(0)) {
            for mo_y in orders(&base.writes(1)) {
                let execution = Execution { mo: [mo_x.clone(), mo_y], ..base.clone() };
                execution.assign(2, &mut outcomes);
            }
        }
    }
    outcomes
}

/// Returns every order of events that begins with the first.
fn orders(events: &[usize]) -> Vec<Vec<usize>> {
    let mut orders = vec![events[..1].to_vec()];
    for event in &events[1..] {
        orders = orders
            .iter()
            .flat_map(|order| {
                (1..=order.len()).map(move |at| {
                    let mut longer = order.clone();
                    longer.insert(at, *event);
                    longer
                })
            })
            .collect();
    }
    orders
}

impl Execution<'_> {
    fn word(&self, event: usize) -> usize {
        if event < 2 { event } else { self.program.operations[event - 2].word }
    }

    fn writes_word(&self, event: usize) -> bool {
        event < 2
            || match self.program.operations[event - 2].kind {
                Kind::Load => false,
                Kind::Store | Kind::Add => true,
                Kind::CompareExchange => self.exchanges[event],
            }
    }

    fn reads_word(&self, event: usize) -> bool {
        event >= 2 && self.program.operations[event - 2].kind != Kind::Store
    }

    fn writes(&self, word: usize) -> Vec<usize> {
        (0..EVENTS).filter(|event| self.word(*event) == word && self.writes_word(*event)).collect()
    }

    /// Assigns a write to every read from `event` on, and records the outcomes of consistent executions.
    fn assign(&self, event: usize, outcomes: &mut Outcomes) {
        if event == EVENTS {
            return self.record(outcomes);
        }
        if !self.reads_word(event) {
            return self.assign(event + 1, outcomes);
        }
        for write in self.mo[self.word(event)].iter().filter(|write| **write != event) {
            let mut next = self.clone();
            next.rf[event] = Some(*write);
            next.assign(event + 1, outcomes);
        }
    }

    fn record(&self, outcomes: &mut Outcomes) {
        let sb = self.program_order();
        let rf: Relation = relation(|a, b| self.rf[b] == Some(a));
        let position = |event: usize| self.mo[self.word(event)].iter().position(|write| *write == event);
        let mo = relation(|a, b| self.word(a) == self.word(b) && position(a).is_some() && position(a) < position(b));
        let fr = relation(|a, b| self.rf[a].is_some_and(|write| a != b && mo[write][b]));
        let is_atomic = (2..EVENTS).filter(|event| self.reads_word(*event) && self.writes_word(*event)).all(|event| {
            let before = position(event).and_then(|at| at.checked_sub(1)).map(|at| self.mo[self.word(event)][at]);
            before == self.rf[event]
        });
        let eco = closure(union(&[rf, mo, fr]));
        let hb = closure(union(&[sb, self.synchronises(&rf)]));
        let is_coherent = (0..EVENTS).all(|a| (0..EVENTS).all(|b| !(eco[a][b] && (a == b || hb[b][a])) && !hb[a][a]));
        if !is_atomic || !is_coherent {
            return;
        }
        let Some(outcome) = self.outcome() else { return };
        let causal = closure(union(&[sb, rf]));
        if (0..EVENTS).all(|event| !causal[event][event]) {
            outcomes.ordered.insert(outcome);
        }
        outcomes.all.insert(outcome);
    }

    fn program_order(&self) -> Relation {
        relation(|a, b| (a < 2 && b >= 2) || (a == 2 && b == 3) || (a == 4 && b == 5))
    }

    /// Returns synchronises-with between accesses: a fence comes after the first access of each invocation, so the second
    /// access of one is released, and the first access of the other acquires.
    fn synchronises(&self, rf: &Relation) -> Relation {
        let is_update = |event: usize| event >= 2 && self.reads_word(event) && self.writes_word(event);
        // Release sequences: from a write through read-modify-writes.
        let through = closure(relation(|a, b| rf[a][b] && is_update(b)));
        relation(|a, b| {
            // From the first access of one invocation to the second of the other, through both fences.
            let (released, acquired) = match (a, b) {
                (2, 5) => (3, 4),
                (4, 3) => (5, 2),
                _ => return false,
            };
            let heads = |head: usize| self.writes_word(head) && (head == released);
            let reads = |write: usize| self.rf[acquired] == Some(write);
            self.program.fences[0]
                && self.program.fences[1]
                && (0..EVENTS)
                    .any(|write| reads(write) && (heads(write) || through[released][write] && heads(released)))
        })
    }

    /// Returns the outcome. `None`: a value would depend on itself, or a compare-exchange does not find what it expects.
    fn outcome(&self) -> Option<Outcome> {
        let mut seen = [0; 4];
        for (at, operation) in self.program.operations.iter().enumerate() {
            let event = at + 2;
            let Some(write) = self.rf[event] else { continue };
            let old = self.value(write, EVENTS)?;
            let is_expected = old == operation.expected;
            if self.exchanges[event] && !is_expected {
                return None;
            }
            seen[at] = 2 * old + u32::from(self.exchanges[event]);
        }
        let last = |word: usize| self.value(self.mo[word][self.mo[word].len() - 1], EVENTS);
        Some(Outcome { seen, words: [last(0)?, last(1)?] })
    }

    /// Returns the value of a write, through at most `depth` read-modify-writes.
    fn value(&self, write: usize, depth: usize) -> Option<u32> {
        if write < 2 {
            return Some(0);
        }
        let operation = &self.program.operations[write - 2];
        match operation.kind {
            Kind::Add => Some(self.value(self.rf[write]?, depth.checked_sub(1)?)? + operation.value),
            _ => Some(operation.value),
        }
    }
}

fn relation(holds: impl Fn(usize, usize) -> bool) -> Relation {
    std::array::from_fn(|a| std::array::from_fn(|b| holds(a, b)))
}

fn union(relations: &[Relation]) -> Relation {
    relation(|a, b| relations.iter().any(|one| one[a][b]))
}

fn closure(mut relation: Relation) -> Relation {
    for middle in 0..EVENTS {
        for from in 0..EVENTS {
            for to in 0..EVENTS {
                relation[from][to] |= relation[from][middle] && relation[middle][to];
            }
        }
    }
    relation
}
