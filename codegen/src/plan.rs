//! Turns a selection of rows into a plan: resources with bindings, steps with the resources that they use, sizes as formulas.
//!
//! Planning begins with the steps of the storage; the other rows edit them in the order of the axes. A plan contains no source code.

mod described;
mod dump;
mod edit;
mod formulas;
mod implementations;
mod notation;
mod resource;
mod summary;
mod textures;

pub(crate) use described::{IMAGE, IMAGE_WORDS};
pub use formulas::bucket;
pub(crate) use implementations::{axis_of, instance_row};
use notation::{normal_form, runs, words_per_pixel};
use resource::size;
pub use resource::{Part, PlannedResource};
pub use summary::Arrival;

use std::sync::Arc;

use fragbuf_model::{Diagnostic, Diagnostics, Selection, Variant, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    BindingTime, Capability, Element, Feature, FormulaError, Hazard, Init, Kind, Lifetime, Resource, Soundness, Step,
};

use crate::frame::{LoweredSteps, LoweringContext, lower};
use crate::{Layout, LoweredFrame, PassId, PlannedPass, ResourceId, SymbolId, SymbolTable};

/// The first binding of a resource. The bindings before it belong to the frame, the description's uniforms and the camera.
pub const FIRST_BINDING: u32 = 3;

/// The passes, memory and frame of a variant, with one choice on every axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The variant.
    pub variant: Variant,
    /// The selected rows.
    pub selection: Selection,
    /// The memory layout of an entry.
    pub layout: Layout,
    /// Constants that are generated in every pass that mentions them.
    pub constants: Vec<(String, u32)>,
    /// The symbols of the plan's formulas.
    pub symbols: Arc<SymbolTable>,
    /// The fields of the uniform block `frame` in shaders, all `u32`.
    pub fields: Vec<SymbolId>,
    /// The buffers and textures.
    pub resources: Vec<PlannedResource>,
    /// The passes, in the order of the frame.
    pub passes: Vec<PlannedPass>,
    /// The commands of a frame.
    pub frame: LoweredFrame,
    /// Words per pixel in the notation of the papers: k entries, f fragments of the pixel, f_k = min(f, k).
    pub words_per_pixel: String,
    /// How many times the scene is drawn.
    pub geometry_passes: String,
    /// The features that a target must provide.
    pub requires: Vec<Feature>,
    /// The soundness tier.
    pub soundness: Soundness,
    /// The declared hazards.
    pub hazards: Vec<Hazard>,
}

/// Plans one selection of a variant's rows.
pub fn plan(variant: &Variant, selection: &Selection, registry: &Registry) -> Result<Plan, Diagnostics> {
    let layout = Layout::of(variant, selection);
    let has_user_row = selection
        .rows
        .iter()
        .any(|selected| selected.row.template.as_ref().is_some_and(|template| template.user_file.is_some()));
    let error = |problem: String| {
        // What built-in rows need of each other is tested; a user's row may provide a capability without the passes behind it.
        let (code, help) = match has_user_row {
            true => (
                codes::INVALID_ROW,
                "the header of the user file must declare the passes and buffers that the capabilities stand for which it provides: \
                 add them, such as `//: pass reset: …`, or leave out the capability",
            ),
            false => (codes::INTERNAL, "report this defect with the description"),
        };
        Diagnostics::from(Diagnostic::new(code, &variant.name.span, problem, help))
    };
    let rows = || selection.rows.iter().map(|selected| &*selected.row);
    let (mut symbols, constants) = formulas::symbols(variant, selection, &layout)?;
    formulas::check_user_formulas(variant, selection, &symbols)?;
    let built = build((variant, selection), registry, (&symbols, &layout), &constants).map_err(error)?;
    bound_k(variant, &mut symbols).map_err(|problem| error(problem.to_string()))?;
    let provides = selection.provides();
    let given = variant.description_values(selection);
    let mut requires: Vec<Feature> = selection.rows.iter().flat_map(|selected| selected.needs(&given)).collect();
    requires.sort();
    requires.dedup();
    Ok(Plan {
        variant: variant.clone(),
        selection: selection.clone(),
        layout,
        constants,
        fields: fields(variant, &symbols, &built),
        geometry_passes: runs(&built.lowered.frame, &built.lowered.passes, &symbols, &|pass| {
            pass.kind == Kind::Geometry
        })
        .to_string(),
        words_per_pixel: words_per_pixel(&built.resources, &symbols).to_string(),
        resources: built.resources,
        passes: built.lowered.passes,
        frame: built.lowered.frame,
        symbols: Arc::new(symbols),
        requires,
        soundness: selection.soundness(),
        hazards: rows()
            .flat_map(|row| row.hazards.iter().cloned())
            .filter(|hazard| hazard.unless.is_none_or(|capability| !provides.contains(&capability)))
            .collect(),
    })
}

/// Sets the range of k, 1 to the capacity, and its default, the value of the description.
fn bound_k(variant: &Variant, symbols: &mut SymbolTable) -> Result<(), FormulaError> {
    let default = variant.keep.map(|_| symbols.compile(&"keep".into())).transpose()?;
    symbols.set_range(SymbolId::K, (1, u64::from(bucket(variant.keep))), default);
    Ok(())
}

/// The resources and steps of a plan.
struct Built {
    resources: Vec<PlannedResource>,
    lowered: LoweredSteps,
}

fn build(
    (variant, selection): (&Variant, &Selection),
    registry: &Registry,
    (symbols, layout): (&SymbolTable, &Layout),
    constants: &[(String, u32)],
) -> Result<Built, String> {
    let mut resources: Vec<Resource> =
        selection.rows.iter().flat_map(|selected| selected.row.resources.iter().cloned()).collect();
    let mut steps: Vec<Step> = selection.rows.iter().flat_map(|selected| selected.row.steps.iter().cloned()).collect();
    for selected in &selection.rows {
        for change in &selected.row.edits {
            edit::apply(change, &mut steps, &mut resources, constants, variant)?;
        }
    }
    described::add(variant, &mut steps, &mut resources);
    implementations::complete(&mut steps, &mut resources, selection, registry)?;
    edit::choose_accesses(&mut steps, selection.provides().contains(&Capability::MutualExclusion));
    let declared: Vec<String> = resources.iter().map(|resource| resource.name.clone()).collect();
    let resources = textures::split(resources, &mut steps, layout);
    let steps = with_clears(resources.iter().map(|(resource, _)| resource), steps);
    let mut planned = Vec::with_capacity(resources.len());
    for (binding, (resource, part)) in (FIRST_BINDING..).zip(resources) {
        let named = |error: FormulaError| format!("`{}`: {error}", resource.name);
        let words = size(&resource).and_then(|size| symbols.compile(&size)).map_err(named)?;
        normal_form(words.formula(), symbols).map_err(named)?;
        let lengths = resource.extents.iter().map(|extent| symbols.length(&extent.length));
        let lengths = lengths.collect::<Result<_, _>>().map_err(named)?;
        planned.push(PlannedResource { resource, binding, words, lengths, part });
    }
    let context = LoweringContext { resources: &planned, declared: &declared, symbols, registry };
    let lowered = lower(&steps, &context)?;
    Ok(Built { resources: planned, lowered })
}

/// Returns the steps with clears of the resources that are cleared at the start of a frame, or at the start of each iteration of a
/// loop that restarts and uses them. A clear precedes all steps there, or follows the host step that sets the size of the resource.
fn with_clears<'r>(resources: impl Iterator<Item = &'r Resource>, mut steps: Vec<Step>) -> Vec<Step> {
    let mut resources: Vec<&Resource> =
        resources.filter(|resource| resource.lifetime != Lifetime::Persistent).collect();
    for step in &mut steps {
        let Step::Repeat(repeat) = step else { continue };
        if repeat.restarts {
            let is_restarted =
                |resource: &&Resource| resource.lifetime == Lifetime::Frame && accesses(&repeat.body, &resource.name);
            let (inside, outside): (Vec<&Resource>, Vec<&Resource>) = resources.into_iter().partition(is_restarted);
            repeat.body = with_clears_first(&inside, std::mem::take(&mut repeat.body));
            resources = outside;
        }
    }
    with_clears_first(&resources, steps)
}

fn with_clears_first(resources: &[&Resource], steps: Vec<Step>) -> Vec<Step> {
    let is_sized_by = |resource: &Resource, step: &Step| {
        let Step::Host(host) = step else { return false };
        // The default of `n` depends on `fragments`. Memory is allocated for every k.
        let sized = |symbol: &String| match symbol.as_str() {
            "k" => false,
            "fragments" => resource.mentions("fragments") || resource.mentions("n"),
            other => resource.mentions(other),
        };
        host.sets.iter().any(sized)
    };
    let (mut first, mut after): (Vec<Step>, Vec<Vec<Step>>) = (Vec::new(), vec![Vec::new(); steps.len()]);
    for resource in resources {
        let Init::Clear(value) = resource.init else { continue };
        let clear = Step::Clear { resource: resource.name.clone(), value };
        match steps.iter().rposition(|step| is_sized_by(resource, step)) {
            Some(index) => after[index].push(clear),
            None => first.push(clear),
        }
    }
    let rest = steps.into_iter().zip(after).flat_map(|(step, clears)| std::iter::once(step).chain(clears));
    first.into_iter().chain(rest).collect()
}

/// Returns whether a pass of these steps uses a resource.
fn accesses(steps: &[Step], resource: &str) -> bool {
    steps.iter().any(|step| match step {
        Step::Pass(pass) => pass.accesses(resource),
        Step::Repeat(repeat) => accesses(&repeat.body, resource),
        _ => false,
    })
}

/// Returns the fields of `frame` in shaders: the size, the first row of a slice (0: there are no slices), k if the description
/// limits it, and the iteration if there are loops. Also every symbol that gets its value after allocation, and on which the size of
/// a resource depends or which a host step sets.
fn fields(variant: &Variant, symbols: &SymbolTable, built: &Built) -> Vec<SymbolId> {
    let is_sized = |id| built.resources.iter().any(|planned| planned.words.mentions(id));
    let is_decided = |id: &SymbolId| built.lowered.frame.decisions().any(|decision| decision.sets.contains(id));
    let is_field = |id: SymbolId, when: BindingTime| match id {
        SymbolId::WIDTH | SymbolId::HEIGHT | SymbolId::FIRST_ROW => true,
        SymbolId::K => variant.keep.is_some() || is_decided(&id),
        SymbolId::ITERATION => !built.lowered.frame.loops.is_empty(),
        _ => when == BindingTime::Readback && (is_sized(id) || is_decided(&id)),
    };
    symbols.iter().filter(|(id, symbol)| is_field(*id, symbol.when)).map(|(id, _)| id).collect()
}

impl Plan {
    /// Returns the largest k that the code supports.
    pub fn capacity(&self) -> u32 {
        self.symbols.number(SymbolId::CAPACITY).and_then(|number| u32::try_from(number).ok()).unwrap_or(0)
    }

    /// Tests whether `frame` in shaders has a field for the symbol.
    pub fn has_field(&self, id: SymbolId) -> bool {
        self.fields.contains(&id)
    }

    /// Tests whether passes read memory of other pixels, so that a frame cannot be divided into slices.
    pub fn needs_whole_frame(&self) -> bool {
        !self.variant.images.is_empty()
    }

    /// Returns a resource by name.
    pub fn resource(&self, name: &str) -> Option<&PlannedResource> {
        self.resources.iter().find(|planned| planned.resource.name == name)
    }

    /// Tests whether shaders that use a resource declare it. The value words of a fragment may be none: then the key is all of it.
    pub fn is_declared(&self, planned: &PlannedResource) -> bool {
        planned.resource.element != Element::Value || self.layout.value_words() > 0
    }

    /// Returns the first pass of a name. A query is identified by it, even if several passes have the name.
    pub fn pass_id(&self, name: &str) -> Option<PassId> {
        self.passes.iter().position(|pass| pass.name == name).map(PassId)
    }

    /// Returns the handle of a resource by name.
    pub fn resource_id(&self, name: &str) -> Option<ResourceId> {
        self.resources.iter().position(|planned| planned.resource.name == name).map(ResourceId)
    }
}
