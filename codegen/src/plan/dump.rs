//! Prints a plan for people and snapshots.

use std::fmt::{Display, Formatter, Result, Write};

use fragbuf_templates::vocabulary::{Access, Coverage, Element, Init, Kind, Lifetime, Loads, Objects, Pass, State};

use super::{Plan, PlannedResource};
use crate::{Action, Command, Decision, Key, Loop, LoopUntil, Parity, Range, ResourceId};

impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let technique = self.variant.technique.as_deref().unwrap_or("no technique");
        writeln!(f, "plan {} ({technique})", self.variant.name.value)?;
        match self.variant.keep {
            Some(k) => writeln!(f, "  keep       {k} of capacity {}", self.capacity())?,
            None => writeln!(f, "  keep       all")?,
        }
        let key = if self.layout.key == Key::Depth { "depth" } else { "criterion" };
        let values: Vec<&str> = self.layout.values.iter().map(|word| word.field.as_str()).collect();
        writeln!(f, "  entry      {} words: key ({key}) {}", self.layout.entry_words(), values.join(" "))?;
        writeln!(f, "  axes       {}", self.selection.describe())?;
        writeln!(f, "  memory     {} words per pixel", self.words_per_pixel)?;
        for definition in self.selection.rows.iter().flat_map(|selected| &selected.row.defines) {
            writeln!(f, "  {:<10} {}", definition.symbol, definition.value)?;
        }
        let plural = if self.geometry_passes == "1" { "pass" } else { "passes" };
        writeln!(f, "  geometry   {} {plural}", self.geometry_passes)?;
        writeln!(f, "  soundness  {}", kebab_case(&self.soundness))?;
        let requires: Vec<&str> = self.requires.iter().map(|feature| feature.meaning()).collect();
        writeln!(f, "  requires   {}", if requires.is_empty() { "nothing".to_owned() } else { requires.join("; ") })?;
        for hazard in &self.hazards {
            writeln!(f, "  hazard     {}: {}", hazard.name, hazard.description)?;
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

/// Returns a `Debug` name in kebab case: `DecrementClamp` → `decrement-clamp`.
fn kebab_case(value: &dyn std::fmt::Debug) -> String {
    let mut text = String::new();
    for letter in format!("{value:?}").chars() {
        if letter.is_ascii_uppercase() && !text.is_empty() {
            text.push('-');
        }
        text.push(letter.to_ascii_lowercase());
    }
    text
}

fn resource(planned: &PlannedResource) -> String {
    let resource = &planned.resource;
    let element = match resource.element {
        Element::Texture(format) => format!("texture {}", kebab_case(&format)),
        Element::Texels(dimension) => format!("texture {}", dimension.keyword()),
        element => kebab_case(&element),
    };
    let index: String = resource.extents.iter().map(|e| format!("[{} < {}]", e.name, e.length)).collect();
    let init = match resource.init {
        Init::Clear(value) => format!("clear {value:#x}"),
        init => kebab_case(&init),
    };
    let lifetime = if resource.lifetime == Lifetime::Persistent { ", persistent" } else { "" };
    let (binding, name, words) = (planned.binding, &resource.name, &planned.words);
    let plural = if words.to_string() == "1" { "word" } else { "words" };
    format!("@{binding} {name}{index}: {element} ({words} {plural}), {init}{lifetime} — {}", resource.summary)
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
                let Loop { until, max_iterations, .. } = &plan.frame.loops[id.0];
                let until = match until {
                    LoopUntil::Times => "repeat".to_owned(),
                    LoopUntil::WordIsZero(buffer) => format!("repeat until {} is 0,", name(*buffer)),
                    LoopUntil::NoSamples(pass) => {
                        format!("repeat until no sample passes in {},", plan.passes[pass.0].name)
                    }
                };
                let most = if until == "repeat" { "" } else { "at most " };
                writeln!(f, "{indent}{until} {most}{max_iterations} times")?;
                depth += 1;
            }
            Action::LoopEnd(_) => {}
        }
        exchanged(f, command, plan, &indent)?;
    }
    Ok(())
}

impl Decision {
    /// Returns one line that lists what it reads and sets.
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
        let lags = if self.may_lag { "; may lag" } else { "" };
        format!("{}: reads {}; sets {}{lags}", self.name, reads.join(", "), sets.join(", "))
    }
}

/// Writes which resources are exchanged at a command that uses them.
fn exchanged(f: &mut Formatter<'_>, command: &Command, plan: &Plan, indent: &str) -> Result {
    for ([a, b], parity) in plan.frame.exchanges.iter().zip(&command.parities) {
        let names = [a, b].map(|id| &plan.resources[id.0].resource.name);
        let uses = match &command.action {
            Action::Pass(id) => plan.passes[id.0].accesses(names[0]) || plan.passes[id.0].accesses(names[1]),
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
        kind => kebab_case(kind),
    };
    writeln!(f, "{indent}pass {}: {kind}, skeleton {}", pass.name, pass.skeleton)?;
    let implementations: Vec<String> = pass
        .implementations
        .iter()
        .map(|implementation| match implementation.instance.name == implementation.contract {
            true => format!("{}={}", implementation.contract, implementation.instance.row),
            false => format!(
                "{}={} as {}",
                implementation.contract, implementation.instance.row, implementation.instance.name
            ),
        })
        .collect();
    if !implementations.is_empty() {
        writeln!(f, "{indent}  implementations {}", implementations.join(" "))?;
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
            let access = if usage.access == Access::Read { "read".to_owned() } else { kebab_case(&usage.access) };
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
        let _ = write!(text, "depth {} {}{write}{early}; ", depth.resource, kebab_case(&depth.compare));
    }
    if let Some(stencil) = &state.stencil {
        let (compare, pass, fail) =
            (kebab_case(&stencil.compare), kebab_case(&stencil.pass), kebab_case(&stencil.fail));
        let _ = write!(text, "stencil {} {compare} {}, ", stencil.resource, stencil.reference);
        let _ = write!(text, "pass {pass}, fail {fail}; ");
    }
    for target in &state.targets {
        let _ = write!(text, "target {} {}; ", target.resource, kebab_case(&target.blend));
    }
    if let Some(samples) = &state.samples {
        let coverage = if samples.coverage == Coverage::WholePixel { " whole-pixel" } else { "" };
        let _ = write!(text, "samples {} mask {}{coverage}; ", samples.count, samples.mask);
    }
    text.trim_end_matches("; ").to_owned()
}
