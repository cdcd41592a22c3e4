//! Changes a draft: `--set name=value` overrides the description.

use crate::{
    Alternative, Attribute, Choice, Diagnostic, Draft, Format, Keep, KeepCount, OptionValue, SourceSpan, Spanned,
    codes, nearest_name,
};

/// The source name of changes from outside in messages: the option of the command line.
pub const SET: &str = "--set";

/// Names that users give to k.
const NAMES_OF_K: [&str; 5] = ["keep", "K", "kept", "entries", "count"];

/// Returns the error about a name that is no axis.
fn unknown(name: &str, span: &SourceSpan, help: String) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(codes::UNKNOWN_AXIS, span, format!("unknown axis `{name}`"), help))
}

/// Returns the error about a value.
fn invalid(name: &str, value: &str, span: &SourceSpan, help: String) -> Box<Diagnostic> {
    let message = format!("invalid value `{value}` for `{name}`");
    Box::new(Diagnostic::new(codes::INVALID_OPTION, span, message, help))
}

impl Draft {
    /// Creates a draft with only a preset; its name is the technique's key in UpperCamel.
    pub fn from_technique(key: &str, span: &SourceSpan) -> Self {
        let name: String = key
            .split('_')
            .map(|word| {
                let mut letters = word.chars();
                letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters).collect::<String>()
            })
            .collect();
        let preset = Some(Spanned::new(key.to_owned(), span.clone()));
        Draft { preset, ..Draft::empty(Spanned::new(name, span.clone())) }
    }

    /// Returns the payload of a description without attributes, the papers': `color: rgba8, depth: f32`.
    pub fn papers_payload(&self) -> Vec<Attribute> {
        let attribute = |name: &str, format| Attribute {
            name: Spanned::new(name.to_owned(), self.name.span.clone()),
            format: Spanned::new(format, self.name.span.clone()),
        };
        vec![attribute("color", Format::Rgba8), attribute("depth", Format::F32)]
    }

    /// Sets `k`, an axis, an option as `axis.option`, or the format of an attribute as `fragment.attribute`; overrides the
    /// draft. The rules check values of axes and options later. For `k` and formats, `Err` is the error in the name or the value.
    pub fn set(&mut self, name: &str, value: &str, span: &SourceSpan) -> Result<(), Box<Diagnostic>> {
        if value.trim().is_empty() {
            return Err(invalid(name, value, span, "give a value after the `=`".to_owned()));
        }
        match name.split_once('.') {
            _ if name == "k" => self.set_k(value, span),
            Some(("fragment", attribute)) => self.set_format(attribute, value, span),
            Some(("uniform", uniform)) => {
                let help = format!(
                    "a description does not have the value of a uniform: `--uniform {uniform}={value}` sets it in `render` and `compare`, and \
                     `check` chooses values itself"
                );
                Err(unknown("uniform", span, help))
            }
            Some((axis, option)) => {
                self.set_option(axis, option, value, span);
                Ok(())
            }
            None if NAMES_OF_K.contains(&name) => {
                Err(unknown(name, span, format!("write `k={value}`: k is the number of fragments that a pixel keeps")))
            }
            None if name == "fragment" => {
                Err(unknown(name, span, "give the format of one attribute: `fragment.name=format`".to_owned()))
            }
            None => {
                self.set_axis(name, value, span);
                Ok(())
            }
        }
    }

    fn set_k(&mut self, value: &str, span: &SourceSpan) -> Result<(), Box<Diagnostic>> {
        let count = match value {
            "all" => Some(KeepCount::All),
            number => number.parse().ok().map(KeepCount::AtMost),
        };
        let count = count.ok_or_else(|| invalid("k", value, span, "give a whole number, or `all`".to_owned()))?;
        let criterion = self.keep.take().and_then(|keep| keep.criterion);
        self.keep = Some(Keep { count: Spanned::new(count, span.clone()), criterion });
        Ok(())
    }

    fn set_format(&mut self, name: &str, value: &str, span: &SourceSpan) -> Result<(), Box<Diagnostic>> {
        if self.attributes.is_empty() {
            self.attributes = self.papers_payload();
        }
        let has_closures = self.has_closures();
        let names: Vec<String> = self.attributes.iter().map(|attribute| attribute.name.value.clone()).collect();
        let Some(attribute) = self.attributes.iter_mut().find(|attribute| attribute.name.value == name) else {
            let nearest =
                nearest_name(name, &names).map_or(String::new(), |nearest| format!("did you mean `{nearest}`? "));
            let help = format!("{nearest}the attributes are {}", names.join(", "));
            let message = format!("no attribute `{name}` on a fragment");
            return Err(Box::new(Diagnostic::new(codes::UNKNOWN_FIELD, span, message, help)));
        };
        let full_name = format!("fragment.{name}");
        let formats = |is_valid: &dyn Fn(Format) -> bool| -> String {
            Format::ALL
                .into_iter()
                .filter(|format| is_valid(*format))
                .map(Format::keyword)
                .collect::<Vec<_>>()
                .join(", ")
        };
        let seen = attribute.format.value.wgsl_type();
        let Some(format) = Format::ALL.into_iter().find(|format| format.keyword() == value) else {
            let help = format!("give one of the formats {}", formats(&|_| true));
            return Err(invalid(&full_name, value, span, help));
        };
        if has_closures && format.wgsl_type() != seen {
            let formats = formats(&|format| format.wgsl_type() == seen);
            let help = format!("closures read it as {seen}: give one of the formats {formats}");
            return Err(invalid(&full_name, value, span, help));
        }
        attribute.format = Spanned::new(format, span.clone());
        Ok(())
    }

    /// Whether a closure was type-checked against the current attributes.
    fn has_closures(&self) -> bool {
        let criterion = self.keep.as_ref().is_some_and(|keep| keep.criterion.is_some());
        criterion || !self.constraints.is_empty() || self.has_effect() || !self.images.is_empty()
    }

    /// Whether a closure is the effect.
    fn has_effect(&self) -> bool {
        self.resolve.is_some() || self.between.is_some()
    }

    fn set_axis(&mut self, axis: &str, value: &str, span: &SourceSpan) {
        let alternatives = value
            .split(" else ")
            .map(|value| Alternative {
                value: Spanned::new(value.trim().to_owned(), span.clone()),
                options: Vec::new(),
            })
            .collect();
        self.choose(Choice { axis: Spanned::new(axis.to_owned(), span.clone()), alternatives });
    }

    /// Replaces the choice on an axis.
    pub fn choose(&mut self, choice: Choice) {
        if choice.axis.value == fragbuf_templates::Registry::CLOSURE_AXIS {
            self.resolve = None;
            self.between = None;
        }
        self.choices.retain(|other| other.axis.value != choice.axis.value);
        self.choices.push(choice);
    }

    /// Sets an option. If the draft does not choose on the axis, the new choice has no value: the rules add the option to
    /// the value of the preset or the default.
    fn set_option(&mut self, axis: &str, option: &str, value: &str, span: &SourceSpan) {
        let value = match value.parse() {
            Ok(number) => OptionValue::Number(number),
            Err(_) => OptionValue::Name(value.to_owned()),
        };
        let entry = (Spanned::new(option.to_owned(), span.clone()), Spanned::new(value, span.clone()));
        if !self.choices.iter().any(|choice| choice.axis.value == axis) {
            let alternative = Alternative { value: Spanned::new(String::new(), span.clone()), options: Vec::new() };
            let axis = Spanned::new(axis.to_owned(), span.clone());
            self.choices.push(Choice { axis, alternatives: vec![alternative] });
        }
        for choice in self.choices.iter_mut().filter(|choice| choice.axis.value == axis) {
            for alternative in &mut choice.alternatives {
                alternative.options.retain(|(name, _)| name.value != option);
                alternative.options.push(entry.clone());
            }
        }
    }
}
