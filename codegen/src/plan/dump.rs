//! The plan as a person reads it, and as snapshots keep it.

use std::fmt::{Display, Formatter, Result, Write};

use fragbuf_templates::vocabulary::{
    Access, Coverage, Element, Init, Kind, Life, Loads, Objects, Pass, State, Step, Until,
};

use super::{Plan, Planned};
use crate::Key;

impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let technique = self.variant.technique.as_deref().unwrap_or("no preset");
        writeln!(f, "plan {} ({technique})", self.variant.name.value)?;
        match self.variant.keep {
            Some(k) => writeln!(f, "  keep       {k} of capacity {}", self.bound.value("capacity").unwrap_or(0))?,
            None => writeln!(f, "  keep       all")?,
        }
        let key = if self.layout.key == Key::Depth { "depth" } else { "criterion" };
        let beside: Vec<&str> = self.layout.beside.iter().map(|word| word.field.as_str()).collect();
        writeln!(f, "  entry      {} words: key ({key}) {}", self.layout.entry_words(), beside.join(" "))?;
        writeln!(f, "  axes       {}", self.selection.describe())?;
        writeln!(f, "  memory     {} words per pixel", self.words_per_pixel)?;
        for definition in &self.defined {
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
        writeln!(f, "  frame      {}", self.frame.join(" "))?;
        writeln!(f, "resources")?;
        for planned in &self.resources {
            writeln!(f, "  {}", resource(planned))?;
        }
        writeln!(f, "steps")?;
        steps(f, &self.steps, 1)
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

fn steps(f: &mut Formatter<'_>, list: &[Step], depth: usize) -> Result {
    let indent = "  ".repeat(depth);
    for step in list {
        match step {
            Step::Pass(pass) => pass_lines(f, pass, &indent)?,
            Step::Clear { resource, value } => writeln!(f, "{indent}clear {resource} to {value:#x}")?,
            Step::Copy { from, to } => writeln!(f, "{indent}copy {from} to {to}")?,
            Step::Swap(a, b) => writeln!(f, "{indent}swap {a} and {b}")?,
            Step::Host(host) => {
                let (function, reads, sets) = (&host.function, host.reads.join(", "), host.sets.join(", "));
                writeln!(f, "{indent}host {function}: reads {reads}; sets {sets}")?;
            }
            Step::Repeat(repeat) => {
                let until = match &repeat.until {
                    Until::Times(times) => format!("{times} times"),
                    Until::Zero(counter) => format!("until {counter} is 0"),
                    Until::NoSamples(pass) => format!("until no sample passes in {pass}"),
                };
                writeln!(f, "{indent}repeat {until}, at most {}", repeat.at_most)?;
                steps(f, &repeat.body, depth + 1)?;
            }
        }
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
