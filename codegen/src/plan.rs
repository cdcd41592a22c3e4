//! A selection of rows becomes a plan: resources with bindings, steps with everything that they touch, sizes as formulas.
//!
//! The storage's steps are the start; the other rows edit them in the order of the axes. No text, no naga, no wgpu.

mod dump;
mod edit;
mod roles;
mod summary;
mod textures;

pub(crate) use roles::{axis_of, instance_row};
pub use summary::Arrival;
use summary::{passes, words_per_pixel};

use fragbuf_model::{Diagnostic, Diagnostics, Selection, Variant, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Capability, Definition, Element, Formula, FormulaError, Hazard, Init, Kind, Life, Resource, Soundness, Step,
};

use crate::Layout;

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
    /// Symbols that are bound by now.
    pub bound: Bound,
    /// Symbols that rows give a value.
    pub defined: Vec<Definition>,
    /// Fields of the frame's uniform buffer, all `u32`.
    pub frame: Vec<String>,
    /// What is kept in memory.
    pub resources: Vec<Planned>,
    /// What is done, in order.
    pub steps: Vec<Step>,
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
    pub words: Formula,
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

/// Values of the symbols that are bound when code is generated; parameters of rows by their constants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bound(pub Vec<(String, u64)>);

impl Bound {
    /// The value of `symbol`, if it is bound by now.
    pub fn value(&self, symbol: &str) -> Option<u64> {
        self.0.iter().find(|(name, _)| name == symbol).map(|(_, value)| *value)
    }
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
    let mut bound = Bound(vec![
        ("capacity".to_owned(), u64::from(bucket(variant.keep))),
        ("entry_words".to_owned(), u64::from(layout.entry_words())),
        ("beside_words".to_owned(), u64::from(layout.beside_words())),
    ]);
    let parameters = parameters(selection, &bound).map_err(|error| fault(error.to_string()))?;
    bound.0.extend(parameters.iter().map(|(name, value)| (name.clone(), u64::from(*value))));
    let limit = if variant.keep.is_some() { Limit::K } else { Limit::None };
    let constants = constants(&bound, parameters);
    let built = build(selection, limit, registry, (&bound, &layout), &constants).map_err(fault)?;
    let offers = selection.offers();
    let rows = || selection.rows.iter().map(|selected| &selected.row);
    let mut requires: Vec<Capability> = rows().flat_map(|row| row.needs.iter().copied()).collect();
    requires.sort();
    requires.dedup();
    Ok(Plan {
        variant: variant.clone(),
        selection: selection.clone(),
        layout,
        constants,
        frame: built.frame,
        resources: built.resources,
        geometry_passes: passes(&built.steps, &bound, &|pass| pass.kind == Kind::Geometry).to_string(),
        steps: built.steps,
        words_per_pixel: built.words_per_pixel,
        bound,
        defined: rows().flat_map(|row| row.defines.iter().cloned()).collect(),
        requires,
        soundness: selection.soundness(),
        hazards: rows()
            .flat_map(|row| row.hazards.iter().cloned())
            .filter(|hazard| hazard.unless.is_none_or(|fact| !offers.contains(&fact)))
            .collect(),
    })
}

struct Built {
    frame: Vec<String>,
    resources: Vec<Planned>,
    steps: Vec<Step>,
    words_per_pixel: String,
}

fn build(
    selection: &Selection,
    limit: Limit,
    registry: &Registry,
    (bound, layout): (&Bound, &Layout),
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
    let resources = textures::spread(resources, &mut steps, layout);
    let clears =
        resources.iter().map(|(resource, _)| resource).filter(|resource| resource.life == Life::Frame).filter_map(
            |resource| {
                let Init::Clear(value) = resource.init else { return None };
                Some(Step::Clear { resource: resource.name.clone(), value })
            },
        );
    let steps: Vec<Step> = clears.chain(steps).collect();
    let mut planned = Vec::with_capacity(resources.len());
    for (binding, (resource, part)) in (FIRST_BINDING..).zip(resources) {
        let words = size(&resource).map_err(|error| error.to_string())?;
        planned.push(Planned { resource, binding, words, part });
    }
    Ok(Built {
        frame: frame(limit, &planned, &steps),
        words_per_pixel: words_per_pixel(&planned, bound).to_string(),
        resources: planned,
        steps,
    })
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
    for factor in &factors {
        factor.read()?;
    }
    let texts: Vec<String> = factors.iter().map(written_factor).collect();
    let text = if texts.is_empty() { "1".to_owned() } else { texts.join(" * ") };
    Ok(text.into())
}

fn written_factor(factor: &Formula) -> String {
    let is_sum = factor.0.contains(" + ") || factor.0.contains(" - ");
    if is_sum && !factor.0.contains('(') { format!("({factor})") } else { factor.to_string() }
}

/// What every program may name, then the parameters of the chosen rows.
fn constants(bound: &Bound, parameters: Vec<(String, u32)>) -> Vec<(String, u32)> {
    let number = |symbol| bound.value(symbol).unwrap_or(0) as u32;
    let mut constants =
        vec![("CAPACITY".to_owned(), number("capacity")), ("BESIDE_WORDS".to_owned(), number("beside_words"))];
    constants.extend(parameters);
    constants
}

/// The parameters of the chosen rows by their constants, as set or by default.
fn parameters(selection: &Selection, bound: &Bound) -> Result<Vec<(String, u32)>, FormulaError> {
    let mut parameters = Vec::new();
    for selected in &selection.rows {
        for parameter in &selected.row.parameters {
            let set = selected.options.iter().find(|(name, _)| *name == parameter.name).map(|(_, value)| *value);
            let value = match set {
                Some(value) => value,
                None => parameter.default.evaluate(&|symbol| bound.value(symbol))? as u32,
            };
            parameters.push((parameter.constant.to_string(), value));
        }
    }
    Ok(parameters)
}

/// Whether a description keeps no more than k.
#[derive(Clone, Copy)]
enum Limit {
    K,
    None,
}

/// The frame's fields: its size, the row at which a slice of a picture begins (0: there are no slices), the round of a loop,
/// and every symbol of a resource's size that is bound later than code.
fn frame(limit: Limit, resources: &[Planned], steps: &[Step]) -> Vec<String> {
    let mut fields = ["width", "height", "first_row"].map(str::to_owned).to_vec();
    if let Limit::K = limit {
        fields.push("k".to_owned());
    }
    for symbol in ["n", "fragments", "kept"] {
        if resources.iter().any(|planned| planned.words.mentions(symbol)) {
            fields.push(symbol.to_owned());
        }
    }
    if steps.iter().any(|step| matches!(step, Step::Repeat(_))) {
        fields.push("iteration".to_owned());
    }
    fields
}

impl Plan {
    /// The passes in the order of the steps, those inside loops included.
    pub fn passes(&self) -> Vec<&fragbuf_templates::vocabulary::Pass> {
        fn collect<'a>(steps: &'a [Step], passes: &mut Vec<&'a fragbuf_templates::vocabulary::Pass>) {
            for step in steps {
                match step {
                    Step::Pass(pass) => passes.push(pass),
                    Step::Repeat(repeat) => collect(&repeat.body, passes),
                    _ => {}
                }
            }
        }
        let mut passes = Vec::new();
        collect(&self.steps, &mut passes);
        passes
    }

    /// Pixels of the frame and of its padding, over its width and height.
    pub fn pixels(&self) -> Formula {
        let defined = self.defined.iter().find(|definition| definition.symbol == "pixels");
        defined.map_or("width * height".into(), |definition| definition.value.clone())
    }

    /// A resource by name.
    pub fn resource(&self, name: &str) -> Option<&Planned> {
        self.resources.iter().find(|planned| planned.resource.name == name)
    }
}
