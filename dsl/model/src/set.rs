//! Changes from outside the text: what `--set name=value` does to a draft.

use crate::{Alternative, Choice, Draft, Keep, KeepCount, OptionValue, Origin, Spanned};

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

    /// Sets `k`, an axis, or an option as `axis.option`, over whatever the draft says.
    /// A value that is no number where one is needed is left to the checks, except for `k`: `Err` says what it must be.
    pub fn set(&mut self, name: &str, value: &str, origin: &Origin) -> Result<(), String> {
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
            Some((axis, option)) => self.set_option(axis, option, value, origin),
            None => self.set_axis(name, value, origin),
        }
        Ok(())
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
