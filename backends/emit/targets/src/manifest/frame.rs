//! Writes the `steps` of a manifest: one JSON object per command of the lowered frame, in order. A loop is a pair of steps that
//! refer to each other by index.

use fragbuf_codegen::{
    Action, Command, Decision, LoopId, LoopUntil, Parity, Plan, PlannedPass, Quantity, Range, ResourceId, SymbolId,
};
use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, DepthState, Element, Kind, Objects, State, StencilOperation, StencilState,
};
use serde_json::{Map, Value, json};

use super::resources::texel;
use super::{Context, bindings};
use crate::names::kebab_case;

/// Returns the steps of a frame.
pub(super) fn steps(context: &Context<'_>) -> Value {
    context.plan.frame.commands.iter().map(|command| step(context, command)).collect()
}

/// Returns the pairs of resources that the frame exchanges, and whether each is exchanged at the end of the frame.
pub(super) fn exchanges(plan: &Plan) -> Value {
    let ends = plan.frame.exchanges.iter().zip(&plan.frame.end);
    ends.map(|(pair, parity)| exchanged(plan, *pair, parity)).collect()
}

fn name(plan: &Plan, id: ResourceId) -> &str {
    &plan.resources[id.0].resource.name
}

fn step(context: &Context<'_>, command: &Command) -> Value {
    let Context { plan, .. } = *context;
    let mut step = match &command.action {
        Action::Pass(id) => {
            let mut step = pass_json(&plan.passes[id.0]);
            bindings::insert(context, id.0, &mut step);
            step
        }
        Action::Clear { resource, value } => object(clear(plan, *resource, *value)),
        Action::Copy { from, to } => object(json!({ "do": "copy", "from": name(plan, *from), "to": name(plan, *to) })),
        Action::Host(decision) => object(host(plan, decision)),
        Action::Loop(id) => {
            let looped = &plan.frame.loops[id.0];
            object(json!({ "do": "loop", "max_iterations": looped.max_iterations.to_string(), "end": looped.end }))
        }
        Action::LoopEnd(id) => loop_end(plan, *id),
    };
    let exchanges = plan.frame.exchanges.iter().zip(&command.parities);
    let flipped = exchanges.filter(|(pair, parity)| uses(plan, command, pair) && **parity != Parity::default());
    let exchanged: Vec<Value> = flipped.map(|(pair, parity)| exchanged(plan, *pair, parity)).collect();
    if !exchanged.is_empty() {
        step.insert("exchanged".into(), exchanged.into());
    }
    step.into()
}

fn clear(plan: &Plan, id: ResourceId, value: u32) -> Value {
    let mut step = json!({ "do": "clear", "resource": name(plan, id), "value": value });
    if let Element::Texture(format) = plan.resources[id.0].resource.element {
        step["texel"] = texel(format, value);
    }
    step
}

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

fn loop_end(plan: &Plan, id: LoopId) -> Map<String, Value> {
    let looped = &plan.frame.loops[id.0];
    let mut map = object(json!({ "do": "loop_end", "begin": looped.begin }));
    match looped.until {
        LoopUntil::Times => {}
        LoopUntil::WordIsZero(word) => drop(map.insert("until".into(), json!({ "word_is_zero": name(plan, word) }))),
        LoopUntil::NoSamples(pass) => {
            drop(map.insert("until".into(), json!({ "no_samples": plan.passes[pass.0].name })));
        }
    }
    map
}

fn host(plan: &Plan, decision: &Decision) -> Value {
    let read = |range: &Range| {
        let (first, count) = (range.first.to_string(), range.count.to_string());
        json!({ "resource": name(plan, range.resource), "first": first, "count": count })
    };
    let reads: Vec<Value> = decision.reads.iter().map(read).collect();
    let sets: Vec<&str> = decision.sets.iter().map(|id| &*plan.symbols.get(*id).name).collect();
    let mut step = json!({ "do": "host", "function": decision.name, "reads": reads, "sets": sets });
    if decision.may_lag {
        step["may_lag"] = true.into();
    }
    step
}

/// Tests whether a command uses one resource of a pair.
fn uses(plan: &Plan, command: &Command, pair: &[ResourceId; 2]) -> bool {
    match &command.action {
        Action::Pass(id) => pair.iter().any(|resource| plan.passes[id.0].accesses(name(plan, *resource))),
        Action::Clear { resource, .. } => pair.contains(resource),
        Action::Copy { from, to } => pair.contains(from) || pair.contains(to),
        Action::Host(decision) => decision.reads.iter().any(|range| pair.contains(&range.resource)),
        Action::Loop(_) => false,
        Action::LoopEnd(id) => match plan.frame.loops[id.0].until {
            LoopUntil::WordIsZero(word) => pair.contains(&word),
            _ => false,
        },
    }
}

/// Describes when two resources are exchanged: if exactly one of these holds: `odd` is true; the total of finished iterations of
/// `loops` is odd. `loops` are the indices of the loops' first steps.
fn exchanged(plan: &Plan, pair: [ResourceId; 2], parity: &Parity) -> Value {
    let loops: Vec<usize> = parity.loops.iter().map(|id| plan.frame.loops[id.0].begin).collect();
    json!({ "resources": pair.map(|id| name(plan, id)), "odd": parity.is_odd, "loops": loops })
}

fn pass_json(pass: &PlannedPass) -> Map<String, Value> {
    let uses: Map<String, Value> =
        pass.uses.iter().map(|usage| (usage.resource.clone(), access(usage.access).into())).collect();
    let mut map = Map::new();
    map.insert("do".into(), "pass".into());
    map.insert("pass".into(), pass.name.clone().into());
    let kind = match &pass.kind {
        Kind::Geometry => "geometry",
        Kind::Fullscreen => "fullscreen",
        Kind::Compute { .. } => "compute",
    };
    map.insert("kind".into(), kind.into());
    if !pass.groups.is_empty() {
        map.insert("groups".into(), pass.groups.iter().map(|groups| groups.to_string()).collect());
    }
    if pass.kind == Kind::Fullscreen {
        map.insert("vertices".into(), 3.into());
    }
    if !pass.constants.is_empty() {
        let constants = pass.constants.iter().map(|(name, value)| (name.clone(), Value::from(*value)));
        map.insert("text_constants".into(), constants.collect::<Map<_, _>>().into());
    }
    map.insert("uses".into(), uses.into());
    map.insert("state".into(), state(&pass.state));
    let changing = per_iteration(pass);
    if !changing.is_empty() {
        map.insert("per_iteration".into(), changing.into());
    }
    match &pass.objects {
        Objects::All => {}
        Objects::Boxes => {
            map.insert("objects".into(), "boxes".into());
        }
        Objects::Visible(query) => {
            map.insert("objects".into(), json!({ "visible_in": query }));
        }
    }
    map
}

/// Returns the members of a pass whose formulas have another value in each iteration of the loop around it.
fn per_iteration(pass: &PlannedPass) -> Vec<&'static str> {
    let changes = |quantity: &Quantity| quantity.mentions(SymbolId::ITERATION);
    let members = [
        ("groups", pass.groups.iter().any(changes)),
        ("state.stencil.reference", pass.reference.as_ref().is_some_and(changes)),
        ("state.samples.count", pass.samples.as_ref().is_some_and(|[count, _]| changes(count))),
        ("state.samples.mask", pass.samples.as_ref().is_some_and(|[_, mask]| changes(mask))),
    ];
    members.into_iter().filter(|(_, changes)| *changes).map(|(name, _)| name).collect()
}

/// Returns the name of an access.
pub(crate) fn access(access: Access) -> &'static str {
    match access {
        Access::Read => "read",
        Access::Plain => "plain",
        // Followers bind both in the same way.
        Access::Atomic | Access::Hinted => "atomic",
        Access::Coherent => "coherent",
        Access::Attachment => "attachment",
        Access::Sampled => "sampled",
        Access::Indirect => "indirect",
    }
}

fn state(state: &State) -> Value {
    let mut map = Map::new();
    if let Some(DepthState { resource, compare, write, early }) = &state.depth {
        let compare = compare_name(*compare);
        map.insert("depth".into(), json!({ "resource": resource, "compare": compare, "write": write, "early": early }));
    }
    if let Some(StencilState { resource, compare, fail, pass, reference }) = &state.stencil {
        let value = json!({
            "resource": resource,
            "compare": compare_name(*compare),
            "fail": stencil_operation(*fail),
            "pass": stencil_operation(*pass),
            "reference": reference.0,
        });
        map.insert("stencil".into(), value);
    }
    let targets = state.targets.iter().map(|t| json!({ "resource": t.resource, "blend": blend(t.blend) }));
    map.insert("targets".into(), targets.collect());
    if let Some(samples) = &state.samples {
        let coverage = kebab_case(&format!("{:?}", samples.coverage));
        let (count, mask) = (&samples.count.0, &samples.mask.0);
        map.insert("samples".into(), json!({ "count": count, "mask": mask, "coverage": coverage }));
    }
    map.into()
}

fn compare_name(compare: Compare) -> String {
    kebab_case(&format!("{compare:?}"))
}

fn stencil_operation(operation: StencilOperation) -> String {
    kebab_case(&format!("{operation:?}"))
}

/// Returns blending as the factors and the operation that every API has, for colour and alpha alike, in the words of WebGPU; `null`: off.
fn blend(blend: Blend) -> Value {
    let (source, destination, operation) = match blend {
        Blend::Replace => return Value::Null,
        Blend::Over => ("one", "one-minus-src-alpha", "add"),
        Blend::Under => ("one-minus-dst-alpha", "one", "add"),
        Blend::Max => ("one", "one", "max"),
        Blend::Min => ("one", "one", "min"),
        Blend::Add => ("one", "one", "add"),
    };
    json!({ "name": kebab_case(&format!("{blend:?}")), "source": source, "destination": destination, "operation": operation })
}
