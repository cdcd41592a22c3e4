//! Changes a draft: `--set name=value` overrides the description.

use crate::{Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, OptionValue, SourceSpan, Spanned};

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
    /// draft. The rules check values of axes and options later. For `k` and formats, `Err` is the expected value.
    pub fn set(&mut self, name: &str, value: &str, span: &SourceSpan) -> Result<(), String> {
        if value.trim().is_empty() {
            return Err("a value after the `=`".to_owned());
        }
        if name == "k" {
            let count = match value {
                "all" => KeepCount::All,
                _ => KeepCount::AtMost(value.parse().map_err(|_| "a whole number, or `all`".to_owned())?),
            };
            let criterion = self.keep.take().and_then(|keep| keep.criterion);
            self.keep = Some(Keep { count: Spanned::new(count, span.clone()), criterion });
            return Ok(());
        }
        match name.split_once('.') {
            Some(("fragment", attribute)) => return self.set_format(attribute, value, span),
            Some((axis, option)) => self.set_option(axis, option, value, span),
            None => self.set_axis(name, value, span),
        }
        Ok(())
    }

    fn set_format(&mut self, name: &str, value: &str, span: &SourceSpan) -> Result<(), String> {
        let format = Format::ALL.into_iter().find(|format| format.keyword() == value);
        let format = format.ok_or_else(|| format!("a format: {}", Format::ALL.map(Format::keyword).join(", ")))?;
        if self.attributes.is_empty() {
            self.attributes = self.papers_payload();
        }
        let names: Vec<String> =
            self.attributes.iter().map(|attribute| format!("`{}`", attribute.name.value)).collect();
        let has_closures = self.has_closures();
        let Some(attribute) = self.attributes.iter_mut().find(|attribute| attribute.name.value == name) else {
            return Err(format!("the format of an existing attribute: {}", names.join(", ")));
        };
        let seen = attribute.format.value.wgsl_type();
        if has_closures && format.wgsl_type() != seen {
            let compatible = Format::ALL.into_iter().filter(|format| format.wgsl_type() == seen).map(Format::keyword);
            return Err(format!(
                "a format that closures read as {seen}: {}",
                compatible.collect::<Vec<_>>().join(", ")
            ));
        }
        attribute.format = Spanned::new(format, span.clone());
        Ok(())
    }

    /// Whether a closure was type-checked against the current attributes.
    fn has_closures(&self) -> bool {
        let criterion = self.keep.as_ref().is_some_and(|keep| keep.criterion.is_some());
        criterion || !self.constraints.is_empty() || self.resolve.is_some()
    }

    fn set_axis(&mut self, axis: &str, value: &str, span: &SourceSpan) {
        let alternatives = value
            .split(" else ")
            .map(|value| Alternative {
                value: Spanned::new(value.trim().to_owned(), span.clone()),
                options: Vec::new(),
            })
            .collect();
        self.choices.retain(|choice| choice.axis.value != axis);
        self.choices.push(Choice { axis: Spanned::new(axis.to_owned(), span.clone()), alternatives });
        if axis == fragbuf_templates::Registry::CLOSURE_AXIS {
            self.resolve = None;
        }
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
