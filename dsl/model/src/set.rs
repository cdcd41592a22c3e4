//! Changes from outside the text: what `--set name=value` does to a draft.

use crate::{Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, OptionValue, Origin, Spanned};

impl Draft {
    /// The draft that takes everything from a technique; its name is the technique's in UpperCamel.
    pub fn from_technique(key: &str, origin: &Origin) -> Self {
        let name: String = key
            .split('_')
            .map(|word| {
                let mut letters = word.chars();
                letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters).collect::<String>()
            })
            .collect();
        let preset = Some(Spanned::new(key.to_owned(), origin.clone()));
        Draft { preset, ..Draft::empty(Spanned::new(name, origin.clone())) }
    }

    /// The payload of a description that names none, the papers': `color: rgba8, depth: f32`.
    pub fn papers_payload(&self) -> Vec<Attribute> {
        let attribute = |name: &str, format| Attribute {
            name: Spanned::new(name.to_owned(), self.name.origin.clone()),
            format: Spanned::new(format, self.name.origin.clone()),
        };
        vec![attribute("color", Format::Rgba8), attribute("depth", Format::F32)]
    }

    /// Sets `k`, an axis, an option as `axis.option`, or the format of an attribute as `fragment.attribute`, over whatever
    /// the draft says. What the rows of an axis make of a value is left to the checks; for `k` and formats `Err` says what
    /// the value must be.
    pub fn set(&mut self, name: &str, value: &str, origin: &Origin) -> Result<(), String> {
        if value.trim().is_empty() {
            return Err("a value behind the `=`".to_owned());
        }
        if name == "k" {
            let count = match value {
                "all" => KeepCount::All,
                _ => KeepCount::AtMost(value.parse().map_err(|_| "a whole number, or `all`".to_owned())?),
            };
            let criterion = self.keep.take().and_then(|keep| keep.criterion);
            self.keep = Some(Keep { count: Spanned::new(count, origin.clone()), criterion });
            return Ok(());
        }
        match name.split_once('.') {
            Some(("fragment", attribute)) => return self.set_format(attribute, value, origin),
            Some((axis, option)) => self.set_option(axis, option, value, origin),
            None => self.set_axis(name, value, origin),
        }
        Ok(())
    }

    fn set_format(&mut self, name: &str, value: &str, origin: &Origin) -> Result<(), String> {
        let known = || Format::ALL.map(Format::keyword).join(", ");
        let format = Format::ALL.into_iter().find(|format| format.keyword() == value);
        let format = format.ok_or_else(|| format!("a format: {}", known()))?;
        if self.attributes.is_empty() {
            self.attributes = self.papers_payload();
        }
        let names: Vec<String> =
            self.attributes.iter().map(|attribute| format!("`{}`", attribute.name.value)).collect();
        let has_closures = self.has_closures();
        let Some(attribute) = self.attributes.iter_mut().find(|attribute| attribute.name.value == name) else {
            return Err(format!("the format of an attribute that there is: {}", names.join(", ")));
        };
        let seen = attribute.format.value.wgsl_type();
        if has_closures && format.wgsl_type() != seen {
            let alike = Format::ALL.into_iter().filter(|format| format.wgsl_type() == seen).map(Format::keyword);
            return Err(format!(
                "a format that is {seen} to the description's closures: {}",
                alike.collect::<Vec<_>>().join(", ")
            ));
        }
        attribute.format = Spanned::new(format, origin.clone());
        Ok(())
    }

    /// Whether some function has been checked against the attributes as they are.
    fn has_closures(&self) -> bool {
        let criterion = self.keep.as_ref().is_some_and(|keep| keep.criterion.is_some());
        criterion || !self.constraints.is_empty() || self.resolve.is_some()
    }

    fn set_axis(&mut self, axis: &str, value: &str, origin: &Origin) {
        let alternatives = value
            .split(" else ")
            .map(|value| Alternative {
                value: Spanned::new(value.trim().to_owned(), origin.clone()),
                options: Vec::new(),
            })
            .collect();
        self.choices.retain(|choice| choice.axis.value != axis);
        self.choices.push(Choice { axis: Spanned::new(axis.to_owned(), origin.clone()), alternatives });
        if axis == fragbuf_templates::Registry::CLOSURE_AXIS {
            self.resolve = None;
        }
    }

    /// An option of an axis that the draft does not choose on belongs to the value that will be chosen; the checks fill it
    /// in, so the choice is recorded without a value.
    fn set_option(&mut self, axis: &str, option: &str, value: &str, origin: &Origin) {
        let value = match value.parse() {
            Ok(number) => OptionValue::Number(number),
            Err(_) => OptionValue::Word(value.to_owned()),
        };
        let entry = (Spanned::new(option.to_owned(), origin.clone()), Spanned::new(value, origin.clone()));
        if !self.choices.iter().any(|choice| choice.axis.value == axis) {
            let alternative = Alternative { value: Spanned::new(String::new(), origin.clone()), options: Vec::new() };
            let axis = Spanned::new(axis.to_owned(), origin.clone());
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
