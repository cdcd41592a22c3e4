//! The items of a buffer.
//!
//! Input: items from the grammar or the builder, one at a time. Output: [`Items`] without duplicates; function bodies are
//! not type-checked.

use fragbuf_model::{
    Attribute, Choice, Diagnostic, Incomplete, KeepCount, SourceSpan, Spanned, Texture, Uniform, codes,
};

use crate::declarations::{self, Declaration};
use crate::raw_function::{FunctionTokens, RawFunction, Role};
use crate::report::{FIRST, Report};

/// A description as written: `buffer Name from technique { items }`.
pub(crate) struct RawDescription {
    pub name: Spanned<String>,
    pub preset: Option<Spanned<String>>,
    pub items: Items,
}

/// The items of a buffer.
#[derive(Default)]
pub(crate) struct Items {
    pub attributes: Vec<Attribute>,
    pub uniforms: Vec<Uniform>,
    pub textures: Vec<Texture>,
    /// The names of images, in the user's order.
    pub images: Vec<Spanned<String>>,
    /// The names of attributes with an unknown format.
    pub invalid_attributes: Vec<String>,
    /// The names of uniforms with an unknown type, and of textures with an unknown dimension.
    pub invalid_uniforms: Vec<String>,
    /// The count of `keep`, and the span of the item.
    pub keep: Option<(Spanned<KeepCount>, SourceSpan)>,
    pub choices: Vec<Choice>,
    /// Criterion, constraints, resolve and helpers, in the user's order.
    pub functions: Vec<RawFunction>,
    /// The tokens of the same functions, including those that do not parse.
    pub function_tokens: Vec<FunctionTokens>,
    /// The names of constants, which are errors: their uses are not reported.
    pub constants: Vec<String>,
    /// The span of the closure of the effect, which `functions` lacks if it has errors.
    pub effect: Option<SourceSpan>,
    /// The parts with errors that are not in this list.
    pub incomplete: Incomplete,
    fragment_block: Option<SourceSpan>,
    uniform_block: Option<SourceSpan>,
    texture_block: Option<SourceSpan>,
    constraints: usize,
}

/// The most textures of a description: WebGPU's default of sampled textures per stage, without those of rows.
const MOST_TEXTURES: usize = 12;

/// The most images of a description, each a buffer that a pass may bind.
const MOST_IMAGES: usize = 8;

impl Items {
    /// Adds the block `fragment`; a second block is an error.
    pub(crate) fn add_attributes(&mut self, rows: Vec<Declaration>, span: &SourceSpan, report: &mut Report) {
        let (attributes, invalid) = declarations::attributes(rows, report);
        if is_first(&mut self.fragment_block, span, "fragment", report) {
            (self.attributes, self.invalid_attributes) = (attributes, invalid);
        }
    }

    /// Adds the block `uniform`; a second block is an error.
    pub(crate) fn add_uniforms(&mut self, rows: Vec<Declaration>, span: &SourceSpan, report: &mut Report) {
        let (uniforms, invalid) = declarations::uniforms(rows, report);
        if is_first(&mut self.uniform_block, span, "uniform", report) {
            self.uniforms = uniforms;
            self.invalid_uniforms.extend(invalid);
        }
    }

    /// Adds the block `texture`; a second block is an error.
    pub(crate) fn add_textures(&mut self, rows: Vec<Declaration>, span: &SourceSpan, report: &mut Report) {
        let (textures, invalid) = declarations::textures(rows, report);
        if is_first(&mut self.texture_block, span, "texture", report) {
            self.textures = textures;
            self.invalid_uniforms.extend(invalid);
        }
    }

    /// Adds an image.
    pub(crate) fn add_image(&mut self, name: Spanned<String>, function: RawFunction) {
        self.images.push(name);
        self.functions.push(function);
    }

    /// Reports textures and images beyond their greatest numbers, and removes them.
    fn reject_too_many(&mut self, report: &mut Report) {
        for (names, most, what) in [
            (self.textures.iter().map(|texture| &texture.name).collect::<Vec<_>>(), MOST_TEXTURES, "textures"),
            (self.images.iter().collect(), MOST_IMAGES, "images"),
        ] {
            if let Some(name) = names.get(most) {
                let message = format!("more than {most} {what}");
                let help = format!("devices bind no more in every pass: join several {what} into one");
                report.push(Diagnostic::new(codes::UNSUPPORTED, &name.span, message, help));
            }
        }
        self.images.truncate(MOST_IMAGES);
        self.textures.truncate(MOST_TEXTURES);
    }

    /// Reports names that two of the uniforms, textures and images have, because closures read all of them in the same way. Removes the second
    /// of each.
    pub(crate) fn reject_names_twice(&mut self, report: &mut Report) {
        self.reject_too_many(report);
        let mut seen: Vec<Spanned<String>> = self.uniforms.iter().map(|uniform| uniform.name.clone()).collect();
        let mut is_new = |name: &Spanned<String>, what: &str| {
            let first = seen.iter().find(|other| other.value == name.value).cloned();
            match &first {
                Some(first) => {
                    let message = format!("duplicate name `{}`: closures read both as `u.{0}`", name.value);
                    let help = format!("rename the {what}");
                    report.push(Diagnostic::new(codes::DUPLICATE, &name.span, message, help).label(&first.span, FIRST));
                }
                None => seen.push(name.clone()),
            }
            first.is_none()
        };
        self.textures.retain(|texture| is_new(&texture.name, "texture"));
        self.images.retain(|name| is_new(name, "image"));
        let mut left: Vec<&str> = self.images.iter().map(|name| name.value.as_str()).collect();
        self.functions.retain(|function| {
            let Role::Image(name) = &function.role else { return true };
            // The first function of an image that is left.
            let place = left.iter().position(|image| image == name);
            place.map(|place| left.remove(place)).is_some()
        });
    }

    /// Adds `keep`; a second one is an error.
    pub(crate) fn add_keep(
        &mut self,
        count: Spanned<KeepCount>,
        criterion: Option<RawFunction>,
        span: SourceSpan,
        report: &mut Report,
    ) {
        if let Some((_, first)) = &self.keep {
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &span, "duplicate `keep`", "remove one of them");
            report.push(diagnostic.label(first, FIRST));
            return;
        }
        self.keep = Some((count, span));
        self.functions.extend(criterion);
    }

    /// Returns the role of the next constraint.
    pub(crate) fn next_constraint(&mut self) -> Role {
        self.constraints += 1;
        Role::Constraint(self.constraints - 1)
    }

    /// Adds the closure of `resolve` or `between`; a second effect is an error.
    pub(crate) fn add_resolve(&mut self, function: RawFunction, span: &SourceSpan, report: &mut Report) {
        match self.resolve_span().or_else(|| self.choice_span("resolve")) {
            Some(first) => {
                let message = "a description has one effect";
                let help = "remove one: `resolve`, `between`, or the effect by its name";
                report.push(Diagnostic::new(codes::DUPLICATE, span, message, help).label(first, FIRST));
            }
            None => self.functions.push(function),
        }
    }

    /// Adds a helper function; a second one of the same name is an error.
    pub(crate) fn add_helper(&mut self, function: RawFunction, report: &mut Report) {
        if let Some(first) = self.functions.iter().find(|other| other.role == function.role) {
            let message = format!("duplicate function `{}`", function.role.rust_name());
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &function.name_span, message, "rename one of them");
            report.push(diagnostic.label(&first.name_span, FIRST));
            return;
        }
        self.functions.push(function);
    }

    /// Adds a choice; a second one for the same axis is an error.
    pub(crate) fn add_choice(&mut self, choice: Choice, report: &mut Report) {
        let axis = choice.axis.value.as_str();
        let closure = if axis == "resolve" { self.resolve_span() } else { None };
        match self.choice_span(axis).or(closure) {
            Some(first) => report.push(duplicate(axis, &choice.axis.span, first)),
            None => self.choices.push(choice),
        }
    }

    fn resolve_span(&self) -> Option<&SourceSpan> {
        let is_effect = |function: &&RawFunction| matches!(function.role, Role::Resolve | Role::Between);
        self.functions.iter().find(is_effect).map(|function| &function.span)
    }

    fn choice_span(&self, axis: &str) -> Option<&SourceSpan> {
        self.choices.iter().find(|choice| choice.axis.value == axis).map(|choice| &choice.axis.span)
    }
}

fn duplicate(axis: &str, span: &SourceSpan, first: &SourceSpan) -> Diagnostic {
    let message = format!("duplicate `{axis}`");
    let help = "remove one; write alternatives on one line: `first else second`";
    Diagnostic::new(codes::DUPLICATE, span, message, help).label(first, FIRST)
}

fn is_first(slot: &mut Option<SourceSpan>, span: &SourceSpan, block: &str, report: &mut Report) -> bool {
    if let Some(first) = slot {
        let message = format!("duplicate block `{block} {{ }}`");
        let diagnostic = Diagnostic::new(codes::DUPLICATE, span, message, "merge them into one block");
        report.push(diagnostic.label(first, FIRST));
        return false;
    }
    *slot = Some(span.clone());
    true
}
