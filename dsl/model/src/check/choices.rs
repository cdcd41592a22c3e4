//! One choice per axis: the description's, else the preset's, else what suits the storage, else the axis's default.

use std::sync::Arc;

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Axis, Parameter, Row, Takes, Technique};

use super::nearest::{listed, suggestion};
use crate::variant::{Chosen, Selected};
use crate::{Alternative, Attribute, Choice, Diagnostic, Diagnostics, Draft, OptionValue, Origin, Spanned, codes};

/// The preset that the draft names.
pub(super) fn technique<'a>(
    draft: &Draft,
    registry: &'a Registry,
    diagnostics: &mut Diagnostics,
) -> Option<&'a Technique> {
    let preset = draft.preset.as_ref()?;
    let technique = registry.technique(&preset.value);
    if technique.is_none() {
        let known: Vec<&str> = registry.techniques().iter().map(|technique| technique.key.as_str()).collect();
        diagnostics.push(Diagnostic::new(
            codes::UNKNOWN_TECHNIQUE,
            &preset.origin,
            format!("there is no technique `{}`", preset.value),
            suggestion(&preset.value, &known, "the techniques are"),
        ));
    }
    technique
}

/// The choices on all axes that a user chooses on, in the order of the axes.
pub(super) fn resolve(
    draft: &Draft,
    attributes: &[Attribute],
    technique: Option<&Technique>,
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Vec<Chosen> {
    unknown_axes(draft, registry, diagnostics);
    if draft.preset.is_some() && technique.is_none() {
        // Without its preset nothing is known of the other choices; only what the description says can be looked up.
        for choice in &draft.choices {
            if registry.axis(&choice.axis.value).is_some_and(|axis| axis.chosen) {
                said(choice, attributes, registry, diagnostics);
            }
        }
        return Vec::new();
    }
    let mut choices: Vec<Chosen> = Vec::new();
    for axis in registry.axes().iter().filter(|axis| axis.chosen) {
        let chosen = match draft.choices.iter().find(|choice| choice.axis.value == axis.key) {
            Some(choice) if !choice.only_options() => {
                closure_and_effect(draft, choice, diagnostics);
                said(choice, attributes, registry, diagnostics)
            }
            Some(choice) => unsaid(axis, draft, technique, &choices, registry, diagnostics)
                .map(|chosen| with_options(chosen, choice, attributes, diagnostics)),
            None => unsaid(axis, draft, technique, &choices, registry, diagnostics),
        };
        choices.extend(chosen);
    }
    choices
}

fn unknown_axes(draft: &Draft, registry: &Registry, diagnostics: &mut Diagnostics) {
    let known: Vec<&str> = registry.axes().iter().filter(|axis| axis.chosen).map(|axis| axis.key).collect();
    for (index, choice) in draft.choices.iter().enumerate() {
        let axis = &choice.axis;
        if !known.contains(&axis.value.as_str()) {
            diagnostics.push(Diagnostic::new(
                codes::UNKNOWN_AXIS,
                &axis.origin,
                format!("there is no axis `{}`", axis.value),
                suggestion(&axis.value, &known, "the axes are"),
            ));
        }
        if let Some(first) = draft.choices[..index].iter().find(|other| other.axis == *axis) {
            diagnostics.push(
                Diagnostic::new(
                    codes::DUPLICATE,
                    &axis.origin,
                    format!("`{}` is chosen twice", axis.value),
                    "keep one of the two; alternatives are joined by `else`",
                )
                .label(&first.axis.origin, "first chosen here"),
            );
        }
    }
}

/// A description with a closure and a named effect says two things.
fn closure_and_effect(draft: &Draft, choice: &Choice, diagnostics: &mut Diagnostics) {
    if let Some(closure) = draft.resolve.as_ref().filter(|_| choice.axis.value == Registry::CLOSURE_AXIS) {
        diagnostics.push(
            Diagnostic::new(
                codes::DUPLICATE,
                &choice.axis.origin,
                "the effect is given twice: by name and as a closure",
                "keep one of the two",
            )
            .label(&closure.origin, "the closure"),
        );
    }
}

/// The options of a choice that names no value belong to the value that is taken anyway.
fn with_options(
    mut chosen: Chosen,
    choice: &Choice,
    attributes: &[Attribute],
    diagnostics: &mut Diagnostics,
) -> Chosen {
    let options = choice.alternatives.iter().flat_map(|alternative| &alternative.options);
    for (name, value) in options {
        // An option belongs to every alternative that has it; where none has, the first says what it has.
        let knows = |selected: &Selected| selected.row.parameters.iter().any(|parameter| parameter.name == name.value);
        let known = chosen.alternatives.iter().any(knows);
        for (index, selected) in chosen.alternatives.iter_mut().enumerate() {
            if knows(selected) || (!known && index == 0) {
                selected.options.extend(option(&selected.row, attributes, name, value, diagnostics));
            }
        }
    }
    chosen
}

/// What the description says on an axis.
fn said(
    choice: &Choice,
    attributes: &[Attribute],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Option<Chosen> {
    let alternatives: Vec<Selected> = choice
        .alternatives
        .iter()
        .filter_map(|alternative| selected(&choice.axis, alternative, attributes, registry, diagnostics))
        .collect();
    let origin = choice.alternatives.first().map_or(&choice.axis.origin, |first| &first.value.origin);
    (!alternatives.is_empty()).then(|| Chosen { axis: choice.axis.value.clone(), origin: origin.clone(), alternatives })
}

fn unsaid(
    axis: &Axis,
    draft: &Draft,
    technique: Option<&Technique>,
    before: &[Chosen],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Option<Chosen> {
    let closure = draft.resolve.as_ref().filter(|_| axis.key == Registry::CLOSURE_AXIS);
    let preset = technique.and_then(|t| t.choices.iter().find(|(name, _)| *name == axis.key)).map(|(_, value)| *value);
    let suited = before
        .iter()
        .filter_map(|chosen| chosen.alternatives.first())
        .flat_map(|selected| &selected.row.defaults)
        .find(|(name, _)| *name == axis.key)
        .map(|(_, value)| value.as_ref());
    let value = closure.map(|_| Registry::CLOSURE).or(preset).or(suited).or(axis.default);
    let origin = draft.preset.as_ref().map_or(&draft.name.origin, |preset| &preset.origin);
    let rows: Option<Vec<&Row>> =
        value.and_then(|value| value.split(" else ").map(|value| registry.row(axis.key, value)).collect());
    let Some(rows) = rows else {
        let known: Vec<&str> = registry.rows_of(axis.key).map(|row| row.key.as_str()).collect();
        diagnostics.push(Diagnostic::new(
            codes::MISSING_STORAGE,
            &draft.name.origin,
            format!("nothing says {}", axis.summary),
            format!(
                "start from a technique (`buffer {} from kplus_array`), or add `{}: …;` with one of {}",
                draft.name.value,
                axis.key,
                listed(&known)
            ),
        ));
        return None;
    };
    let selected = |row: &Row| Selected { row: Arc::new(row.clone()), options: Vec::new() };
    let alternatives = rows.into_iter().map(selected).collect();
    Some(Chosen { axis: axis.key.to_owned(), origin: origin.clone(), alternatives })
}

fn selected(
    axis: &Spanned<String>,
    alternative: &Alternative,
    attributes: &[Attribute],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Option<Selected> {
    registry.axis(&axis.value).filter(|axis| axis.chosen)?;
    let value = &alternative.value;
    let Some(row) = registry.row(&axis.value, &value.value).filter(|row| row.key != Registry::CLOSURE) else {
        if let Some(path) = alternative.file() {
            diagnostics.push(Diagnostic::new(
                codes::MISSING_FILE,
                &value.origin,
                format!("nothing has read `{path}`"),
                "files are read where a description is loaded from a file; add its row to the registry before the check",
            ));
            return None;
        }
        let known: Vec<&str> =
            registry.rows_of(&axis.value).map(|row| row.key.as_str()).filter(|key| *key != Registry::CLOSURE).collect();
        diagnostics.push(Diagnostic::new(
            codes::UNKNOWN_VALUE,
            &value.origin,
            format!("`{}` is no value of the axis `{}`", value.value, axis.value),
            suggestion(&value.value, &known, &format!("the values of `{}` are", axis.value)),
        ));
        return None;
    };
    let options = alternative
        .options
        .iter()
        .filter_map(|(name, value)| option(row, attributes, name, value, diagnostics))
        .collect();
    Some(Selected { row: Arc::new(row.clone()), options })
}

fn option(
    row: &Row,
    attributes: &[Attribute],
    name: &Spanned<String>,
    value: &Spanned<OptionValue>,
    diagnostics: &mut Diagnostics,
) -> Option<(String, u32)> {
    let Some(parameter) = row.parameters.iter().find(|parameter| parameter.name == name.value) else {
        let known: Vec<&str> = row.parameters.iter().map(|parameter| &*parameter.name).collect();
        let hint = if known.is_empty() {
            format!("`{}` has no options: drop the braces", row.key)
        } else {
            suggestion(&name.value, &known, &format!("the options of `{}` are", row.key))
        };
        diagnostics.push(Diagnostic::new(
            codes::UNKNOWN_OPTION,
            &name.origin,
            format!("`{}` has no option `{}`", row.key, name.value),
            hint,
        ));
        return None;
    };
    let number = match (&value.value, parameter.takes) {
        (OptionValue::Number(number), Takes::Number) => Some(*number).filter(|number| in_range(parameter, *number)),
        (OptionValue::Number(number), Takes::PowerOfTwo) => {
            Some(*number).filter(|number| number.is_power_of_two() && in_range(parameter, *number))
        }
        (OptionValue::Word(word), Takes::Attribute) => {
            attributes.iter().position(|attribute| attribute.name.value == *word).map(|index| index as u32)
        }
        _ => None,
    };
    if number.is_none() {
        diagnostics.push(bad_option(parameter, attributes, &value.origin));
    }
    number.map(|number| (name.value.clone(), number))
}

fn in_range(parameter: &Parameter, number: u32) -> bool {
    (parameter.range.0..=parameter.range.1).contains(&number)
}

fn bad_option(parameter: &Parameter, attributes: &[Attribute], origin: &Origin) -> Diagnostic {
    let (least, greatest) = parameter.range;
    let names: Vec<&str> = attributes.iter().map(|attribute| attribute.name.value.as_str()).collect();
    let wanted = match parameter.takes {
        Takes::Number => format!("a whole number from {least} to {greatest}"),
        Takes::PowerOfTwo => format!("a power of two from {least} to {greatest}"),
        Takes::Attribute => format!("an attribute of the payload: {}", listed(&names)),
    };
    Diagnostic::new(
        codes::BAD_OPTION,
        origin,
        format!("`{}` is {wanted}", parameter.name),
        format!("{}; {} when nothing is said", parameter.summary, parameter.default),
    )
}
