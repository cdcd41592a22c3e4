//! The plan as a person reads it, and as snapshots keep it.

use std::fmt::{Display, Formatter, Result, Write};

use fragbuf_templates::vocabulary::{Access, Coverage, Element, Init, Kind, Life, Loads, Objects, Pass, State};

use super::{Plan, Planned};
use crate::{Action, Command, Decision, Key, Loop, LoopUntil, Parity, Range, ResourceId};

impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let technique = self.variant.technique.as_deref().unwrap_or("no preset");
        writeln!(f, "plan {} ({technique})", self.variant.name.value)?;
        match self.variant.keep {
            Some(k) => writeln!(f, "  keep       {k} of capacity {}", self.capacity())?,
            None => writeln!(f, "  keep       all")?,
        }
        let key = if self.layout.key == Key::Depth { "depth" } else { "criterion" };
        let beside: Vec<&str> = self.layout.beside.iter().map(|word| word.field.as_str()).collect();
        writeln!(f, "  entry      {} words: key ({key}) {}", self.layout.entry_words(), beside.join(" "))?;
        writeln!(f, "  axes       {}", self.selection.describe())?;
        writeln!(f, "  memory     {} words per pixel", self.words_per_pixel)?;
        for definition in self.selection.rows.iter().flat_map(|selected| &selected.row.defines) {
            writeln!(f, "  {:<10} {}", definition.symbol, definition.value)?;
        }
        writeln!(f, "  geometry   {} passes", self.geometry_passes)?;
        writeln!(f, "  soundness  {}", word(&self.soundness))?;
        let requires: Vec<&str> = self.requires.iter().map(|capability| capability.meaning()).collect();
        writeln!(f, "  requires   {}", if requires.is_empty() { "nothing".to_owned() } else { requires.join("; ") })?;
        for hazard in &self.hazards {
            writeln!(f, "  hazard     {}: {}", hazard.name, hazard.what)?;
        }
        let constants: Vec<String> = self.constants.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        writeln!(f, "  constants  {}", constants.join(", "))?;
        let fields: Vec<&str> = self.fields.iter().map(|id| &*self.symbols.get(*id).name).collect();
        writeln!(f, "  frame      {}", fields.join(" "))?;
        writeln!(f, "resources")?;
        for planned in &self.resources {
            writeln!(f, "  {}", resource(planned))?;
        }
        writeln!(f, "steps")?;
        commands(f, self)
    }
}

/// A `Debug` name in the words of the language: `DecrementClamp` → `decrement-clamp`.
fn word(value: &dyn std::fmt::Debug) -> String {
    let mut text = String::new();
    for letter in format!("{value:?}").chars() {
        if letter.is_ascii_uppercase() && !text.is_empty() {
            text.push('-');
        }
        text.push(letter.to_ascii_lowercase());
    }
    text
}

fn resource(planned: &Planned) -> String {
    let resource = &planned.resource;
    let element = match resource.element {
        Element::Texture(format) => format!("texture {}", word(&format)),
        element => word(&element),
    };
    let index: String = resource.extents.iter().map(|e| format!("[{} < {}]", e.name, e.length)).collect();
    let init = match resource.init {
        Init::Clear(value) => format!("clear {value:#x}"),
        init => word(&init),
    };
    let life = if resource.life == Life::Persistent { ", persistent" } else { "" };
    let (binding, name, words) = (planned.binding, &resource.name, &planned.words);
    format!("@{binding} {name}{index}: {element} ({words} words), {init}{life} — {}", resource.summary)
}

fn commands(f: &mut Formatter<'_>, plan: &Plan) -> Result {
    let mut depth = 1;
    for command in &plan.frame.commands {
        if let Action::LoopEnd(_) = command.action {
            depth -= 1;
            continue;
        }
        let indent = "  ".repeat(depth);
        let name = |id: ResourceId| &plan.resources[id.0].resource.name;
        match &command.action {
            Action::Pass(id) => pass_lines(f, &plan.passes[id.0], &indent)?,
            Action::Clear { resource, value } => writeln!(f, "{indent}clear {} to {value:#x}", name(*resource))?,
            Action::Copy { from, to } => writeln!(f, "{indent}copy {} to {}", name(*from), name(*to))?,
            Action::Host(decision) => writeln!(f, "{indent}host {}", decision.summary(plan))?,
            Action::Loop(id) => {
                let Loop { until, at_most, .. } = &plan.frame.loops[id.0];
                let until = match until {
                    LoopUntil::Times => "repeat".to_owned(),
                    LoopUntil::WordIsZero(word) => format!("repeat until {} is 0,", name(*word)),
                    LoopUntil::NoSamples(pass) => {
                        format!("repeat until no sample passes in {},", plan.passes[pass.0].anchor)
                    }
                };
                let most = if until == "repeat" { "" } else { "at most " };
                writeln!(f, "{indent}{until} {most}{at_most} times")?;
                depth += 1;
            }
            Action::LoopEnd(_) => {}
        }
        flipped(f, command, plan, &indent)?;
    }
    Ok(())
}

impl Decision {
    /// What it reads and sets, in a line.
    pub fn summary(&self, plan: &Plan) -> String {
        let read = |range: &Range| {
            let name = &plan.resources[range.resource.0].resource.name;
            match range.count.to_string().as_str() {
                "1" => format!("{name}[{}]", range.first),
                count => format!("{name}[{}, {count} words]", range.first),
            }
        };
        let reads: Vec<String> = self.reads.iter().map(read).collect();
        let sets: Vec<&str> = self.sets.iter().map(|id| &*plan.symbols.get(*id).name).collect();
        format!("{}: reads {}; sets {}", self.name, reads.join(", "), sets.join(", "))
    }
}

/// Which resources stand for each other at a command that uses them.
fn flipped(f: &mut Formatter<'_>, command: &Command, plan: &Plan, indent: &str) -> Result {
    for ([a, b], parity) in plan.frame.exchanges.iter().zip(&command.parities) {
        let names = [a, b].map(|id| &plan.resources[id.0].resource.name);
        let uses = match &command.action {
            Action::Pass(id) => plan.passes[id.0].touches(names[0]) || plan.passes[id.0].touches(names[1]),
            Action::Clear { resource, .. } => [a, b].contains(&resource),
            Action::Copy { from, to } => [a, b].iter().any(|id| [from, to].contains(id)),
            _ => false,
        };
        if !uses || *parity == Parity::default() {
            continue;
        }
        let loops: Vec<String> = parity.loops.iter().map(|id| format!("loop {}", id.0)).collect();
        let when = match (parity.is_odd, loops.is_empty()) {
            (_, true) => String::new(),
            (false, false) => format!(" after an odd number of iterations of {}", loops.join(" and ")),
            (true, false) => format!(" after an even number of iterations of {}", loops.join(" and ")),
        };
        writeln!(f, "{indent}  {} and {} exchanged{when}", names[0], names[1])?;
    }
    Ok(())
}

fn pass_lines(f: &mut Formatter<'_>, pass: &Pass, indent: &str) -> Result {
    let kind = match &pass.kind {
        Kind::Compute { groups: [x, y, z] } => format!("compute {x} × {y} × {z}"),
        kind => word(kind),
    };
    writeln!(f, "{indent}pass {}: {kind}, skeleton {}", pass.anchor, pass.skeleton)?;
    let roles: Vec<String> = pass
        .roles
        .iter()
        .map(|role| match role.instance.name == role.contract {
            true => format!("{}={}", role.contract, role.instance.row),
            false => format!("{}={} as {}", role.contract, role.instance.row, role.instance.name),
        })
        .collect();
    if !roles.is_empty() {
        writeln!(f, "{indent}  roles {}", roles.join(" "))?;
    }
    let constants: Vec<String> = pass.constants.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    if !constants.is_empty() {
        writeln!(f, "{indent}  constants {}", constants.join(", "))?;
    }
    let uses: Vec<String> = pass
        .uses
        .iter()
        .map(|usage| {
            let loads = if usage.loads == Loads::Rechecked { " (loads rechecked)" } else { "" };
            let access = if usage.access == Access::Read { "read".to_owned() } else { word(&usage.access) };
            format!("{} {access}{loads}", usage.resource)
        })
        .collect();
    if !uses.is_empty() {
        writeln!(f, "{indent}  uses {}", uses.join(", "))?;
    }
    match &pass.objects {
        Objects::All => {}
        Objects::Boxes => writeln!(f, "{indent}  objects by their boxes")?,
        Objects::Visible(query) => writeln!(f, "{indent}  objects visible in {query}")?,
    }
    let state = state(&pass.state);
    if state.is_empty() { Ok(()) } else { writeln!(f, "{indent}  state {state}") }
}

fn state(state: &State) -> String {
    let mut text = String::new();
    if let Some(depth) = &state.depth {
        let write = if depth.write { ", write" } else { "" };
        let early = if depth.early { ", early" } else { "" };
        let _ = write!(text, "depth {} {}{write}{early}; ", depth.resource, word(&depth.compare));
    }
    if let Some(stencil) = &state.stencil {
        let (compare, pass, fail) = (word(&stencil.compare), word(&stencil.pass), word(&stencil.fail));
        let _ = write!(text, "stencil {} {compare} {}, ", stencil.resource, stencil.reference);
        let _ = write!(text, "pass {pass}, fail {fail}; ");
    }
    for target in &state.targets {
        let _ = write!(text, "target {} {}; ", target.resource, word(&target.blend));
    }
    if let Some(samples) = &state.samples {
        let coverage = if samples.coverage == Coverage::WholePixel { " whole-pixel" } else { "" };
        let _ = write!(text, "samples {} mask {}{coverage}; ", samples.count, samples.mask);
    }
    text.trim_end_matches("; ").to_owned()
}
