//! Writes the page of a technique as Markdown, computed from its registry rows.

use std::fmt::Write;

use fragbuf::vocabulary::{Kind, Pass};
use fragbuf::{Generation, Plan, Registry, tier};
use fragbuf_codegen::{Action, Loop, LoopUntil, ResourceId};

/// Returns the page of a technique that was generated for every target.
pub(crate) fn page(generation: &Generation, registry: &Registry) -> String {
    let Some(first) = generation.plans.first().map(|planned| &planned.plan) else { return String::new() };
    let mut text = String::new();
    header(first, registry, &mut text);
    axes(first, &mut text);
    memory(first, &mut text);
    text.push_str("\n## A frame\n\n");
    steps(first, &mut text);
    let is_limit = first.frame.loops.iter().any(|one| one.until != LoopUntil::Times);
    let most = if is_limit { "at most " } else { "" };
    let _ = writeln!(text, "\nThe geometry is drawn {most}{} time(s).", first.geometry_passes);
    targets(generation, &mut text);
    hazards(first, &mut text);
    text
}

fn header(plan: &Plan, registry: &Registry, text: &mut String) {
    let technique = plan.variant.technique.as_deref().and_then(|key| registry.technique(key));
    match technique {
        Some(technique) => {
            let _ = writeln!(
                text,
                "# `{0}`: {1}\n\n{2}.\n\nSource: {3}.\n\n![{0}](../gallery/{0}.png)\n",
                technique.key,
                technique.title,
                sentence(technique.summary),
                technique.paper
            );
            let _ = writeln!(
                text,
                "```text\nbuffer Mine from {0} {{ … }}                                  # your own description\n\
                 fragbuf generate {0} --target all --out {0}    # its passes\n\
                 fragbuf render {0} --scene builtin:marbles --size 320x240 --out {0}.png\n```",
                technique.key
            );
        }
        None => {
            let _ = writeln!(text, "# {}", plan.variant.name.value);
        }
    }
}

/// Capitalises the first letter.
fn sentence(summary: &str) -> String {
    let mut letters = summary.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

fn axes(plan: &Plan, text: &mut String) {
    text.push_str("\n## Axes\n\n| axis | value | summary | source |\n|---|---|---|---|\n");
    for selected in &plan.selection.rows {
        let row = &selected.row;
        let _ = writeln!(text, "| {} | `{}` | {} | {} |", row.axis, row.key, row.summary, row.paper);
        for parameter in &row.parameters {
            let value = plan.constants.iter().find(|(name, _)| *name == parameter.constant).map(|(_, value)| value);
            let value = value.map_or(String::new(), |value| format!(" = {value}"));
            let (least, most) = parameter.range;
            let _ = writeln!(
                text,
                "| | `{}.{}`{value} | {} ({least} to {most}) | |",
                row.axis, parameter.name, parameter.summary
            );
        }
    }
}

fn memory(plan: &Plan, text: &mut String) {
    let _ = writeln!(text, "\n## Memory\n\n**{} words per pixel** for the papers' payload.\n", plan.words_per_pixel);
    for definition in plan.selection.rows.iter().flat_map(|selected| &selected.row.defines) {
        let _ = writeln!(text, "`{}` is `{}`.\n", definition.symbol, definition.value);
    }
    text.push_str("| buffer | words | summary |\n|---|---|---|\n");
    for planned in &plan.resources {
        let _ = writeln!(text, "| `{}` | `{}` | {} |", planned.resource.name, planned.words, planned.resource.summary);
    }
}

fn steps(plan: &Plan, text: &mut String) {
    let mut indent = String::new();
    let name = |id: ResourceId| &plan.resources[id.0].resource.name;
    for command in &plan.frame.commands {
        let line = match &command.action {
            Action::Pass(id) => pass_line(&plan.passes[id.0]),
            Action::Clear { resource, value } => format!("clear `{}` to {value:#x}", name(*resource)),
            Action::Copy { from, to } => format!("copy `{}` to `{}`", name(*from), name(*to)),
            Action::Host(decision) => format!("host {}", decision.summary(plan)),
            Action::Loop(id) => loop_line(plan, &plan.frame.loops[id.0]),
            Action::LoopEnd(_) => {
                indent.truncate(indent.len().saturating_sub(2));
                continue;
            }
        };
        let _ = writeln!(text, "{indent}* {line}");
        if let Action::Loop(_) = command.action {
            indent.push_str("  ");
        }
    }
    if !plan.frame.exchanges.is_empty() {
        let pairs = plan.frame.exchanges.iter().map(|[a, b]| format!("`{}` and `{}`", name(*a), name(*b)));
        let _ = writeln!(text, "\nThe frame exchanges these resources: {}.", pairs.collect::<Vec<_>>().join(", "));
    }
}

/// Returns `once`, or `n times`.
fn times(count: &str) -> String {
    if count == "1" { "once".to_owned() } else { format!("{count} times") }
}

fn loop_line(plan: &Plan, looped: &Loop) -> String {
    let max_iterations = looped.max_iterations.to_string();
    match looped.until {
        LoopUntil::Times => format!("repeat {}", times(&max_iterations)),
        LoopUntil::WordIsZero(word) => {
            format!("repeat, at most {}, until `{}` is 0", times(&max_iterations), plan.resources[word.0].resource.name)
        }
        LoopUntil::NoSamples(pass) => {
            format!("repeat, at most {}, until `{}` draws no sample", times(&max_iterations), plan.passes[pass.0].name)
        }
    }
}

fn pass_line(pass: &Pass) -> String {
    let kind = match &pass.kind {
        Kind::Geometry => "draws the scene".to_owned(),
        Kind::Fullscreen => "draws one triangle over the frame".to_owned(),
        Kind::Compute { groups } => {
            let groups: Vec<String> = groups.iter().map(|formula| formula.0.to_string()).collect();
            format!("dispatches {} workgroups", groups.join(" × "))
        }
    };
    let uses: Vec<String> = pass.uses.iter().map(|usage| format!("`{}`", usage.resource)).collect();
    let uses = if uses.is_empty() { String::new() } else { format!(", over {}", uses.join(", ")) };
    format!("pass **{}** {kind}{uses}", pass.name)
}

fn targets(generation: &Generation, text: &mut String) {
    text.push_str("\n## Targets\n\n| target | tier | axes that differ |\n|---|---|---|\n");
    let first = generation.plans.first().map(|planned| &planned.plan);
    for planned in &generation.plans {
        let differs: Vec<String> = planned
            .plan
            .selection
            .rows
            .iter()
            .filter(|selected| first.is_some_and(|first| !first.selection.rows.contains(selected)))
            .map(|selected| format!("{}: `{}`", selected.row.axis, selected.row.key))
            .collect();
        for target in &planned.targets {
            let _ = writeln!(
                text,
                "| `{}` | {} | {} |",
                target.name,
                tier(planned.plan.soundness, target),
                differs.join(", ")
            );
        }
    }
    for (target, missing) in &generation.unsupported {
        let _ = writeln!(text, "| `{}` | no | {missing} |", target.name);
    }
}

fn hazards(plan: &Plan, text: &mut String) {
    if plan.hazards.is_empty() {
        return;
    }
    text.push_str("\n## Declared hazards\n\n");
    for hazard in &plan.hazards {
        let _ = writeln!(text, "* **{}**: {}", hazard.name, hazard.description);
    }
}
