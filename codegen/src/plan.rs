//! A selection of rows becomes a plan: resources with bindings, steps with everything that they touch, sizes as formulas.
//!
//! The storage's steps are the start; the other rows edit them in the order of the axes. No text, no naga, no wgpu.

mod dump;
mod edit;
mod formulas;
mod roles;
mod summary;
mod textures;

pub(crate) use roles::{axis_of, instance_row};
pub use summary::Arrival;
use summary::{normal_form, passes, words_per_pixel};

use std::sync::Arc;

use fragbuf_model::{Diagnostic, Diagnostics, Selection, Variant, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Capability, Element, Expression, Formula, FormulaError, Hazard, Init, Kind, Life, Resource, Soundness, Step, When,
};

use crate::frame::{Context, Lowered, lower};
use crate::{Layout, LoweredFrame, PassId, PlannedPass, Quantity, ResourceId, SymbolId, SymbolTable};

/// Bindings before this one are the frame's, the description's uniforms and the camera.
pub const FIRST_BINDING: u32 = 3;

/// What a frame of one variant does and keeps, with one choice on every axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// What is planned.
    pub variant: Variant,
    /// The rows.
    pub selection: Selection,
    /// The words of an entry.
    pub layout: Layout,
    /// Constants that are generated into every pass that names them.
    pub constants: Vec<(String, u32)>,
    /// The symbols of its formulas.
    pub symbols: Arc<SymbolTable>,
    /// Fields of the shaders' uniform block `frame`, all `u32`.
    pub fields: Vec<SymbolId>,
    /// What is kept in memory.
    pub resources: Vec<Planned>,
    /// The passes, in the order of the frame.
    pub passes: Vec<PlannedPass>,
    /// What a frame does, in order.
    pub frame: LoweredFrame,
    /// Words per pixel in the papers' notation: k entries kept, f fragments of the pixel, f_k the lesser of the two.
    pub words_per_pixel: String,
    /// Times that the scene is drawn.
    pub geometry_passes: String,
    /// What a target must offer.
    pub requires: Vec<Capability>,
    /// What the safety under concurrency rests on.
    pub soundness: Soundness,
    /// What can go wrong by design.
    pub hazards: Vec<Hazard>,
}

/// A resource of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// The row's resource, named for its instance.
    pub resource: Resource,
    /// Its binding in every pass.
    pub binding: u32,
    /// Its size in words, as one formula.
    pub words: Quantity,
    /// The lengths of its extents.
    pub lengths: Vec<Quantity>,
    /// For a texture that holds one word of a fragment: which.
    pub part: Option<Part>,
}

impl Planned {
    /// Whether the caller brings it, filled, and owns its memory: a texture that the host writes.
    pub fn is_brought(&self) -> bool {
        self.resource.init == Init::Host && matches!(self.resource.element, Element::Texture(_))
    }
}

/// One word of what a row calls one resource, and a plan keeps in a texture for each word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The row's resource.
    pub of: String,
    /// The word's field in `Packed`.
    pub field: String,
}

/// The capacity for k kept fragments: k may change up to it without new code. An A-buffer resolves up to 64 layers unless
/// it is told otherwise.
pub fn bucket(keep: Option<u32>) -> u32 {
    keep.map_or(64, u32::next_power_of_two)
}

/// Plans one selection of a variant's rows.
pub fn plan(variant: &Variant, selection: &Selection, registry: &Registry) -> Result<Plan, Diagnostics> {
    let layout = Layout::of(variant, selection);
    let fault = |problem: String| {
        let hint = "report it with the description; a row of your own must name only what it declares";
        Diagnostics::from(Diagnostic::new(codes::INTERNAL, &variant.name.origin, problem, hint))
    };
    let rows = || selection.rows.iter().map(|selected| &*selected.row);
    let (mut symbols, constants) = formulas::symbols(variant, selection, &layout)?;
    formulas::check(variant, selection, &symbols)?;
    let built = build(selection, registry, (&symbols, &layout), &constants).map_err(fault)?;
    bound_k(variant, &mut symbols).map_err(|error| fault(error.to_string()))?;
    let offers = selection.offers();
    let mut requires: Vec<Capability> = rows().flat_map(|row| row.needs.iter().copied()).collect();
    requires.sort();
    requires.dedup();
    Ok(Plan {
        variant: variant.clone(),
        selection: selection.clone(),
        layout,
        constants,
        fields: fields(variant, &symbols, &built),
        geometry_passes: passes(&built.lowered, &symbols, &|pass| pass.kind == Kind::Geometry).to_string(),
        words_per_pixel: words_per_pixel(&built.resources, &symbols).to_string(),
        resources: built.resources,
        passes: built.lowered.passes,
        frame: built.lowered.frame,
        symbols: Arc::new(symbols),
        requires,
        soundness: selection.soundness(),
        hazards: rows()
            .flat_map(|row| row.hazards.iter().cloned())
            .filter(|hazard| hazard.unless.is_none_or(|fact| !offers.contains(&fact)))
            .collect(),
    })
}

/// k goes from 1 to the capacity, and is what the description says where a frame says nothing.
fn bound_k(variant: &Variant, symbols: &mut SymbolTable) -> Result<(), FormulaError> {
    let default = variant.keep.map(|_| symbols.compile(&"keep".into())).transpose()?;
    symbols.bound(SymbolId::K, (1, u64::from(bucket(variant.keep))), default);
    Ok(())
}

struct Built {
    resources: Vec<Planned>,
    lowered: Lowered,
}

fn build(
    selection: &Selection,
    registry: &Registry,
    (symbols, layout): (&SymbolTable, &Layout),
    constants: &[(String, u32)],
) -> Result<Built, String> {
    let mut resources: Vec<Resource> =
        selection.rows.iter().flat_map(|selected| selected.row.resources.iter().cloned()).collect();
    let mut steps: Vec<Step> = selection.rows.iter().flat_map(|selected| selected.row.steps.iter().cloned()).collect();
    for selected in &selection.rows {
        for change in &selected.row.edits {
            edit::apply(change, &mut steps, &mut resources, constants)?;
        }
    }
    roles::complete(&mut steps, &mut resources, selection, registry)?;
    let declared: Vec<String> = resources.iter().map(|resource| resource.name.clone()).collect();
    let resources = textures::spread(resources, &mut steps, layout);
    let steps = with_clears(resources.iter().map(|(resource, _)| resource), steps);
    let mut planned = Vec::with_capacity(resources.len());
    for (binding, (resource, part)) in (FIRST_BINDING..).zip(resources) {
        let named = |error: FormulaError| format!("`{}`: {error}", resource.name);
        let words = size(&resource).and_then(|size| symbols.compile(&size)).map_err(named)?;
        normal_form(words.formula(), symbols).map_err(named)?;
        let lengths = resource.extents.iter().map(|extent| symbols.length(&extent.length));
        let lengths = lengths.collect::<Result<_, _>>().map_err(named)?;
        planned.push(Planned { resource, binding, words, lengths, part });
    }
    let context = Context { resources: &planned, declared: &declared, symbols, registry };
    let lowered = lower(&steps, &context)?;
    Ok(Built { resources: planned, lowered })
}

/// The steps with the clears of everything that a frame begins with: before them all, or behind the host step that decides how
/// large the resource is.
fn with_clears<'r>(resources: impl Iterator<Item = &'r Resource>, steps: Vec<Step>) -> Vec<Step> {
    let is_sized_by = |resource: &Resource, step: &Step| {
        let Step::Host(host) = step else { return false };
        // Slots per pixel are those of the fragments, unless a step sets them. For any k there is memory.
        let sized = |symbol: &String| match symbol.as_str() {
            "k" => false,
            "fragments" => resource.mentions("fragments") || resource.mentions("n"),
            other => resource.mentions(other),
        };
        host.sets.iter().any(sized)
    };
    let (mut first, mut behind): (Vec<Step>, Vec<Vec<Step>>) = (Vec::new(), vec![Vec::new(); steps.len()]);
    for resource in resources.filter(|resource| resource.life == Life::Frame) {
        let Init::Clear(value) = resource.init else { continue };
        let clear = Step::Clear { resource: resource.name.clone(), value };
        match steps.iter().rposition(|step| is_sized_by(resource, step)) {
            Some(at) => behind[at].push(clear),
            None => first.push(clear),
        }
    }
    let rest = steps.into_iter().zip(behind).flat_map(|(step, clears)| std::iter::once(step).chain(clears));
    first.into_iter().chain(rest).collect()
}

/// Words of a resource: the product of its extents and of an element's words.
fn size(resource: &Resource) -> Result<Formula, FormulaError> {
    let mut factors: Vec<Formula> = resource.extents.iter().map(|extent| extent.length.clone()).collect();
    match resource.element {
        Element::Word => {}
        Element::Word64 => factors.push("2".into()),
        Element::Entry => factors.push("entry_words".into()),
        Element::Beside => factors.push("beside_words".into()),
        Element::Texture(format) if format.words() == 1 => {}
        Element::Texture(format) => factors.push(format.words().to_string().into()),
        Element::BesideTextures(_) => factors.push("beside_words".into()),
        Element::EntryTextures(_) => factors.push("entry_words".into()),
    }
    let texts: Vec<String> =
        factors.iter().enumerate().map(|(at, factor)| written_factor(factor, at == 0)).collect::<Result<_, _>>()?;
    let text = if texts.is_empty() { "1".to_owned() } else { texts.join(" * ") };
    Ok(text.into())
}

/// A factor of a product, in parentheses where the product would come to something else.
fn written_factor(factor: &Formula, is_first: bool) -> Result<String, FormulaError> {
    let is_closed = is_closed(&factor.read()?, is_first);
    Ok(if is_closed { factor.to_string() } else { format!("({factor})") })
}

/// Whether all operators bind as close as that of a product. Only what stands first may divide: elsewhere the rest before
/// it would be divided too.
fn is_closed(factor: &Expression, is_first: bool) -> bool {
    match factor {
        Expression::Apply("*" | "/", _) => is_first || !begins_with_quotient(factor),
        Expression::Apply(operator, _) => operator.starts_with(|sign: char| sign.is_ascii_alphabetic()),
        _ => true,
    }
}

/// Sums that are multiplied stand in parentheses already.
fn begins_with_quotient(factor: &Expression) -> bool {
    match factor {
        Expression::Apply("*", parts) => begins_with_quotient(&parts[0]),
        Expression::Apply(operator, _) => *operator == "/",
        _ => false,
    }
}

/// The fields of the shaders' `frame`: its size, the row at which a slice of a picture begins (0: there are no slices), k
/// where a description keeps no more, the iteration where there are loops, and every symbol that a resource's size rests on,
/// or a host step sets, and that has its value later than memory.
fn fields(variant: &Variant, symbols: &SymbolTable, built: &Built) -> Vec<SymbolId> {
    let is_sized = |id| built.resources.iter().any(|planned| planned.words.mentions(id));
    let is_decided = |id: &SymbolId| built.lowered.frame.decisions().any(|decision| decision.sets.contains(id));
    let is_field = |id: SymbolId, when: When| match id {
        SymbolId::WIDTH | SymbolId::HEIGHT | SymbolId::FIRST_ROW => true,
        SymbolId::K => variant.keep.is_some() || is_decided(&id),
        SymbolId::ITERATION => !built.lowered.frame.loops.is_empty(),
        _ => when == When::Readback && (is_sized(id) || is_decided(&id)),
    };
    symbols.iter().filter(|(id, symbol)| is_field(*id, symbol.when)).map(|(id, _)| id).collect()
}

impl Plan {
    /// The greatest k that the code serves.
    pub fn capacity(&self) -> u32 {
        self.symbols.number(SymbolId::CAPACITY).and_then(|number| u32::try_from(number).ok()).unwrap_or(0)
    }

    /// Whether the shaders' `frame` has a field for the symbol.
    pub fn has_field(&self, id: SymbolId) -> bool {
        self.fields.contains(&id)
    }

    /// A resource by name.
    pub fn resource(&self, name: &str) -> Option<&Planned> {
        self.resources.iter().find(|planned| planned.resource.name == name)
    }

    /// The first pass of an anchor: queries are known by it, however often they are asked.
    pub fn pass_id(&self, anchor: &str) -> Option<PassId> {
        self.passes.iter().position(|pass| pass.anchor == anchor).map(PassId)
    }

    /// The handle of a resource, for what comes from outside.
    pub fn resource_id(&self, name: &str) -> Option<ResourceId> {
        self.resources.iter().position(|planned| planned.resource.name == name).map(ResourceId)
    }
}
