//! One choice per axis: the description's, else the preset's, else the storage's default, else the axis's default.

use std::sync::Arc;

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Axis, Parameter, ParameterType, Row, Technique};

use super::suggestion::{listed, suggestion};
use crate::variant::{AxisChoice, SelectedRow};
use crate::{
    Alternative, Attribute, Choice, Diagnostic, Diagnostics, Draft, OptionValue, Spanned, codes, nearest_name,
};

/// Returns the preset that the draft names.
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
            &preset.span,
            format!("unknown technique `{}`", preset.value),
            suggestion(&preset.value, &known, "the techniques are"),
        ));
    }
    technique
}

/// Returns the choices on all axes that a user can choose on, in the order of the axes.
pub(super) fn resolve(
    draft: &Draft,
    attributes: &[Attribute],
    technique: Option<&Technique>,
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Vec<AxisChoice> {
    check_axes(draft, registry, diagnostics);
    if draft.preset.is_some() && technique.is_none() {
        // Without the preset the other choices are unknown; only the description's own choices can be checked.
        for choice in &draft.choices {
            if registry.axis(&choice.axis.value).is_some_and(|axis| axis.chosen) {
                given_choice(choice, attributes, registry, diagnostics);
            }
        }
        return Vec::new();
    }
    let mut choices: Vec<AxisChoice> = Vec::new();
    for axis in registry.axes().iter().filter(|axis| axis.chosen) {
        let chosen = match draft.choices.iter().find(|choice| choice.axis.value == axis.key) {
            Some(choice) if !choice.only_options() => {
                closure_and_effect(draft, choice, diagnostics);
                given_choice(choice, attributes, registry, diagnostics)
            }
            Some(choice) => default_choice(axis, draft, technique, &choices, registry, diagnostics)
                .map(|chosen| with_options(chosen, choice, attributes, registry, diagnostics)),
            None => default_choice(axis, draft, technique, &choices, registry, diagnostics),
        };
        choices.extend(chosen);
    }
    choices
}

/// Reports unknown axes, and axes that the description chooses twice.
fn check_axes(draft: &Draft, registry: &Registry, diagnostics: &mut Diagnostics) {
    let known: Vec<&str> = registry.axes().iter().filter(|axis| axis.chosen).map(|axis| axis.key).collect();
    for (index, choice) in draft.choices.iter().enumerate() {
        let axis = &choice.axis;
        if !known.contains(&axis.value.as_str()) {
            diagnostics.push(Diagnostic::new(
                codes::UNKNOWN_AXIS,
                &axis.span,
                format!("unknown axis `{}`", axis.value),
                unknown_axis(&axis.value, choice, &known, (draft, registry)),
            ));
        }
        if let Some(first) = draft.choices[..index].iter().find(|other| other.axis == *axis) {
            diagnostics.push(
                Diagnostic::new(
                    codes::DUPLICATE,
                    &axis.span,
                    format!("`{}` is chosen twice", axis.value),
                    "remove one of the two; write alternatives as `a else b`",
                )
                .label(&first.axis.span, "first chosen here"),
            );
        }
    }
}

/// Returns the help for an unknown axis: the axis that has an option of this name, or the nearest name.
fn unknown_axis(name: &str, choice: &Choice, known: &[&str], (draft, registry): (&Draft, &Registry)) -> String {
    let value = choice.alternatives.first().map_or("…", |alternative| alternative.value.value.as_str());
    // `--set` gives choices without a position in a description.
    let is_set = choice.alternatives.first().is_some_and(|first| first.value.span == choice.axis.span);
    if name == "k" {
        return format!("write `keep {value};`");
    }
    if is_set && draft.uniforms.iter().any(|uniform| uniform.name.value == name) {
        return format!("it is a uniform: write `--uniform {name}={value}`");
    }
    match registry.rows().iter().find(|row| known.contains(&&*row.axis) && has_option(row, name)) {
        Some(row) if is_set => {
            format!("it is an option of `{}: {}`: write `{}.{name}={value}`", row.axis, row.key, row.axis)
        }
        Some(row) => format!("it is an option: write `{}: {} {{ {name}: {value} }}`", row.axis, row.key),
        None => suggestion(name, known, "the axes are"),
    }
}

fn has_option(row: &Row, name: &str) -> bool {
    row.parameters.iter().any(|parameter| parameter.name == name)
}

/// Reports an effect that is given both as a closure and by name.
fn closure_and_effect(draft: &Draft, choice: &Choice, diagnostics: &mut Diagnostics) {
    if let Some(closure) =
        draft.resolve.as_ref().or(draft.between.as_ref()).filter(|_| choice.axis.value == Registry::CLOSURE_AXIS)
    {
        diagnostics.push(
            Diagnostic::new(
                codes::DUPLICATE,
                &choice.axis.span,
                "the effect is given twice: by name and as a closure",
                "remove one of the two",
            )
            .label(&closure.span, "the closure"),
        );
    }
}

/// Adds the options of a choice without a value to the alternatives that the preset or a default gives.
fn with_options(
    mut chosen: AxisChoice,
    choice: &Choice,
    attributes: &[Attribute],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> AxisChoice {
    let options = choice.alternatives.iter().flat_map(|alternative| &alternative.options);
    for (name, value) in options {
        // An option belongs to every alternative that has it. If none has it, the first alternative reports the error.
        let has_option =
            |selected: &SelectedRow| selected.row.parameters.iter().any(|parameter| parameter.name == name.value);
        let is_known = chosen.alternatives.iter().any(has_option);
        for (index, selected) in chosen.alternatives.iter_mut().enumerate() {
            if has_option(selected) || (!is_known && index == 0) {
                selected.options.extend(option_number(&selected.row, attributes, (name, value), registry, diagnostics));
            }
        }
    }
    chosen
}

/// Returns the rows that the description chooses on an axis.
fn given_choice(
    choice: &Choice,
    attributes: &[Attribute],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Option<AxisChoice> {
    let alternatives: Vec<SelectedRow> = choice
        .alternatives
        .iter()
        .filter_map(|alternative| selected_row(&choice.axis, alternative, attributes, registry, diagnostics))
        .collect();
    let span = choice.alternatives.first().map_or(&choice.axis.span, |first| &first.value.span);
    (!alternatives.is_empty()).then(|| AxisChoice { axis: choice.axis.value.clone(), span: span.clone(), alternatives })
}

/// Returns the rows of an axis that the description does not choose on.
fn default_choice(
    axis: &Axis,
    draft: &Draft,
    technique: Option<&Technique>,
    earlier: &[AxisChoice],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Option<AxisChoice> {
    let has_closure = draft.resolve.is_some() || draft.incomplete.resolve;
    let closure = match &draft.between {
        Some(_) => Some(Registry::BETWEEN),
        None if has_closure && !draft.images.is_empty() => Some(Registry::STEPS),
        None => Some(Registry::CLOSURE).filter(|_| has_closure),
    };
    let closure = closure.filter(|_| axis.key == Registry::CLOSURE_AXIS);
    let preset = technique.and_then(|t| t.choices.iter().find(|(name, _)| *name == axis.key)).map(|(_, value)| *value);
    let suggested = earlier
        .iter()
        .filter_map(|chosen| chosen.alternatives.first())
        .flat_map(|selected| &selected.row.defaults)
        .find(|(name, _)| *name == axis.key)
        .map(|(_, value)| value.as_ref());
    let value = closure.or(preset).or(suggested).or(axis.default);
    let preset_span = draft.preset.as_ref().map_or(&draft.name.span, |preset| &preset.span);
    let span = match (draft.resolve.as_ref().or(draft.between.as_ref()), &draft.effect) {
        (Some(function), _) if closure.is_some() => &function.span,
        (None, Some(effect)) if closure.is_some() => &effect.span,
        _ => preset_span,
    };
    let rows: Option<Vec<&Row>> =
        value.and_then(|value| value.split(" else ").map(|value| registry.row(axis.key, value)).collect());
    let Some(rows) = rows else {
        // A misspelt name of the axis is reported.
        let known: Vec<&str> = registry.axes().iter().map(|axis| axis.key).collect();
        let is_misspelt = |name: &str| registry.axis(name).is_none() && nearest_name(name, &known) == Some(axis.key);
        let has_choice = draft.choices.iter().any(|choice| is_misspelt(&choice.axis.value));
        if draft.incomplete.preset || draft.incomplete.choices || has_choice {
            return None;
        }
        let known: Vec<&str> = registry.rows_of(axis.key).map(|row| row.key.as_str()).collect();
        diagnostics.push(Diagnostic::new(
            codes::MISSING_STORAGE,
            &draft.name.span,
            format!("no value is chosen for the axis `{}`", axis.key),
            format!(
                "start from a technique (`buffer {} from kplus_array`), or add `{}: …;` with one of {}",
                draft.name.value,
                axis.key,
                listed(&known)
            ),
        ));
        return None;
    };
    let selected = |row: &Row| SelectedRow { row: Arc::new(row.clone()), options: Vec::new() };
    let alternatives = rows.into_iter().map(selected).collect();
    Some(AxisChoice { axis: axis.key.to_owned(), span: span.clone(), alternatives })
}

/// Returns the row and the options of one alternative.
fn selected_row(
    axis: &Spanned<String>,
    alternative: &Alternative,
    attributes: &[Attribute],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Option<SelectedRow> {
    registry.axis(&axis.value).filter(|axis| axis.chosen)?;
    let value = &alternative.value;
    let Some(row) = registry.row(&axis.value, &value.value).filter(|row| !Registry::is_of_closures(row)) else {
        if let Some(path) = alternative.file() {
            diagnostics.push(Diagnostic::new(
                codes::MISSING_FILE,
                &value.span,
                format!("the file `{path}` has not been read"),
                "files are read when a description is loaded from a file; otherwise add its row to the registry before the check",
            ));
            return None;
        }
        let known: Vec<&str> = registry
            .rows_of(&axis.value)
            .filter(|row| !Registry::is_of_closures(row))
            .map(|row| row.key.as_str())
            .collect();
        diagnostics.push(Diagnostic::new(
            codes::UNKNOWN_VALUE,
            &value.span,
            format!("the axis `{}` has no value `{}`", axis.value, value.value),
            several_values(&value.value, &known)
                .or_else(|| value_of_technique(&axis.value, &value.value, registry))
                .unwrap_or_else(|| suggestion(&value.value, &known, &format!("the values of `{}` are", axis.value))),
        ));
        return None;
    };
    let options = alternative
        .options
        .iter()
        .filter_map(|(name, value)| option_number(row, attributes, (name, value), registry, diagnostics))
        .collect();
    Some(SelectedRow { row: Arc::new(row.clone()), options })
}

/// Returns the help for several values in place of one, as `--set` can have them: `a,b`, `a|b` or `a or b`.
fn several_values(value: &str, known: &[&str]) -> Option<String> {
    let text = value.replace(" or ", ",");
    let values: Vec<&str> = text.split([',', '|', '/', ' ']).map(str::trim).filter(|part| !part.is_empty()).collect();
    let is_known = values.len() > 1 && values.iter().all(|value| known.contains(value));
    is_known.then(|| format!("alternatives are separated by `else`: `{}`", values.join(" else ")))
}

/// Returns the help for the key of a technique in place of a value of an axis.
fn value_of_technique(axis: &str, value: &str, registry: &Registry) -> Option<String> {
    let technique = registry.technique(value)?;
    let chosen = technique.choices.iter().find(|(name, _)| *name == axis);
    Some(match chosen {
        Some((_, value)) => {
            let first = value.split(" else ").next().unwrap_or(value);
            format!("`{}` is a technique: its value on this axis is `{axis}: {first}`", technique.key)
        }
        None => format!(
            "`{0}` is a technique, and no value of an axis: start from it, as `buffer B from {0}`",
            technique.key
        ),
    })
}

/// Returns the number of an option that the row has; for an attribute, its index.
fn option_number(
    row: &Row,
    attributes: &[Attribute],
    (name, value): (&Spanned<String>, &Spanned<OptionValue>),
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) -> Option<(String, u32)> {
    let Some(parameter) = row.parameters.iter().find(|parameter| parameter.name == name.value) else {
        let known: Vec<&str> = row.parameters.iter().map(|parameter| &*parameter.name).collect();
        let other = registry.rows_of(&row.axis).find(|other| has_option(other, &name.value));
        let help = match other {
            Some(other) if nearest_name(&name.value, &known).is_none() => {
                format!("choose `{}: {}`, which has this option", other.axis, other.key)
            }
            _ if known.is_empty() => format!("`{}: {}` has no options: remove it", row.axis, row.key),
            _ => suggestion(&name.value, &known, &format!("the options of `{}` are", row.key)),
        };
        diagnostics.push(Diagnostic::new(
            codes::UNKNOWN_OPTION,
            &name.span,
            format!("`{}: {}` has no option `{}`", row.axis, row.key, name.value),
            help,
        ));
        return None;
    };
    let number = match (&value.value, parameter.kind) {
        (OptionValue::Number(number), ParameterType::Number) => {
            Some(*number).filter(|number| in_range(parameter, *number))
        }
        (OptionValue::Number(number), ParameterType::PowerOfTwo) => {
            Some(*number).filter(|number| number.is_power_of_two() && in_range(parameter, *number))
        }
        (OptionValue::Name(name), ParameterType::Attribute) => {
            attributes.iter().position(|attribute| attribute.name.value == *name).map(|index| index as u32)
        }
        _ => None,
    };
    if number.is_none() {
        diagnostics.push(invalid_option(parameter, attributes, value));
    }
    number.map(|number| (name.value.clone(), number))
}

fn in_range(parameter: &Parameter, number: u32) -> bool {
    (parameter.range.0..=parameter.range.1).contains(&number)
}

fn invalid_option(parameter: &Parameter, attributes: &[Attribute], value: &Spanned<OptionValue>) -> Diagnostic {
    let (least, greatest) = parameter.range;
    let names: Vec<&str> = attributes.iter().map(|attribute| attribute.name.value.as_str()).collect();
    let expected = match parameter.kind {
        ParameterType::Number => format!("a whole number from {least} to {greatest}"),
        ParameterType::PowerOfTwo => format!("a power of two from {least} to {greatest}"),
        ParameterType::Attribute => format!("an attribute of the payload: {}", listed(&names)),
    };
    let nearest = match (&value.value, parameter.kind) {
        (OptionValue::Name(name), ParameterType::Attribute) => nearest_name(name, &names),
        _ => None,
    };
    let help = match (nearest, parameter.kind) {
        (Some(nearest), _) => format!("did you mean `{nearest}`?"),
        (None, ParameterType::Attribute) => parameter.summary.to_string(),
        _ => format!("{}; default: {}", parameter.summary, parameter.default),
    };
    let message = format!("`{}` must be {expected}", parameter.name);
    Diagnostic::new(codes::INVALID_OPTION, &value.span, message, help)
}
