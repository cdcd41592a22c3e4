//! Writes the steps of a frame, with its loops, exchanges and host functions. Steps, loops and parities are those of the lowered frame.

use fragbuf_codegen::{Action, LoopUntil, Parity};

use super::Writer;
use super::names::{comment, string};

impl Writer<'_> {
    pub(super) fn exchanges(&mut self) -> (String, usize) {
        let ends = self.plan.frame.exchanges.iter().zip(&self.plan.frame.end);
        let rows: Vec<String> =
            ends.map(|([a, b], end)| format!("{{{{{}, {}}}, {}}},", a.0, b.0, parity(end))).collect();
        self.table("struct fragbuf_exchange", "exchanges", &rows)
    }

    pub(super) fn loops(&mut self) -> (String, usize) {
        let mut rows = Vec::new();
        for (index, looped) in self.plan.frame.loops.iter().enumerate() {
            let limit = self.function(&format!("loop_{index}_max_iterations"), 1, &looped.max_iterations);
            let (until, subject) = match looped.until {
                LoopUntil::Times => ("FRAGBUF_LIMIT", 0),
                LoopUntil::WordIsZero(resource) => ("FRAGBUF_WORD_IS_ZERO", resource.0),
                LoopUntil::NoSamples(pass) => ("FRAGBUF_NO_SAMPLES", pass.0),
            };
            rows.push(format!("{{{}, {}, {until}, {subject}, {limit}}},", looped.begin, looped.end));
        }
        self.table("struct fragbuf_loop", "loops", &rows)
    }

    pub(super) fn hosts(&mut self) -> (String, usize) {
        let mut rows = Vec::new();
        for (index, decision) in self.plan.frame.decisions().enumerate() {
            let mut reads = Vec::new();
            for (number, range) in decision.reads.iter().enumerate() {
                let first = self.function(&format!("host_{index}_read_{number}_first"), 1, &range.first);
                let count = self.function(&format!("host_{index}_read_{number}_count"), 1, &range.count);
                reads.push(format!("{{{}, {first}, {count}}},", range.resource.0));
            }
            let (reads, read_count) = self.table("struct fragbuf_range", &format!("host_{index}_reads"), &reads);
            let sets: Vec<String> = decision
                .sets
                .iter()
                .map(|id| format!("offsetof(struct fragbuf_symbols, {}),", self.plan.symbols.get(*id).name))
                .collect();
            let (sets, set_count) = self.table("size_t", &format!("host_{index}_sets"), &sets);
            let (function, may_lag) = (string(&decision.name), u32::from(decision.may_lag));
            rows.push(format!("{{{function}, {reads}, {read_count}, {sets}, {set_count}, {may_lag}}},"));
        }
        self.table("struct fragbuf_host", "hosts", &rows)
    }

    pub(super) fn steps(&mut self) -> (String, usize) {
        let (mut rows, mut hosts) = (Vec::new(), 0);
        for (index, command) in self.plan.frame.commands.iter().enumerate() {
            let is_plain = command.parities.iter().all(|parity| *parity == Parity::default());
            let parities: Vec<String> =
                command.parities.iter().filter(|_| !is_plain).map(|one| format!("{},", parity(one))).collect();
            let (parities, _) = self.table("struct fragbuf_parity", &format!("step_{index}_parities"), &parities);
            let resource = |index: usize| self.plan.resources.get(index).map_or("", |planned| &planned.resource.name);
            let (action, subject, value, note) = match &command.action {
                Action::Clear { resource: id, value } => ("CLEAR", id.0, format!("UINT32_C({value})"), resource(id.0)),
                Action::Copy { from, to } => ("COPY", from.0, to.0.to_string(), resource(from.0)),
                Action::Pass(id) => {
                    let name = self.plan.passes.get(id.0).map_or("", |pass| &pass.name);
                    ("PASS", id.0, "0".to_owned(), name)
                }
                Action::Loop(id) => ("LOOP", id.0, "0".to_owned(), ""),
                Action::LoopEnd(id) => ("LOOP_END", id.0, "0".to_owned(), ""),
                Action::Host(decision) => {
                    hosts += 1;
                    ("HOST", hosts - 1, "0".to_owned(), decision.name.as_str())
                }
            };
            let note = if note.is_empty() { String::new() } else { format!(" /* {} */", comment(note)) };
            rows.push(format!("{{FRAGBUF_{action}, {subject}, {value}, {parities}}},{note}"));
        }
        self.table("struct fragbuf_step", "steps", &rows)
    }
}

/// Returns a parity. A frame has far fewer loops than the mask has bits.
fn parity(parity: &Parity) -> String {
    let mask = parity
        .loops
        .iter()
        .filter_map(|id| 1u64.checked_shl(u32::try_from(id.0).ok()?))
        .fold(0, |mask, bit| mask | bit);
    format!("{{{}, UINT64_C({mask})}}", u32::from(parity.is_odd))
}
