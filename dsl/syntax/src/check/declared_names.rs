//! Names that are declared, but written without what they belong to: `depth` in place of `f.depth`, `f.cut` in place of `u.cut`.
//!
//! Input: an unknown name, and where it is written. Output: the help of the error. A near name is suggested with its prefix, whether it is
//! an attribute, a uniform or a variable.

use fragbuf_model::nearest_name;

use super::checker::Checker;
use crate::types::{Shape, Type};
use crate::unknown_name;

/// The place of an unknown name.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// A value by itself, `name`.
    Value,
    /// An attribute of a fragment, `f.name`.
    Attribute,
    /// A uniform, `u.name`.
    Uniform,
}

impl Checker<'_, '_, '_> {
    /// Returns the help for an unknown name.
    pub(super) fn help_for_name(&self, name: &str, place: Place) -> String {
        let (attributes, uniforms) = (&self.environment.attributes, &self.environment.uniforms);
        let has = |list: &[(String, Type)]| list.iter().any(|(other, _)| other == name);
        if has(attributes) {
            return format!("it is an attribute: {}", self.write_attribute(name));
        }
        if has(uniforms) {
            let ty = uniforms.iter().find(|(other, _)| other == name).map(|(_, ty)| *ty);
            let what = match ty {
                Some(Type::Texture(Shape::Image)) => "an image",
                Some(Type::Texture(_)) => "a texture",
                _ => "a uniform",
            };
            return format!("it is {what}: {}", self.write_uniform(name));
        }
        if let (Place::Value, Some(help)) = (place, self.help_for_parameter(name)) {
            return help;
        }
        let locals: Vec<&str> = if place == Place::Value { self.locals() } else { Vec::new() };
        let names = |list| names_of(list);
        // The first of equally near names is suggested: those of the place.
        let known = match place {
            Place::Value => [locals.clone(), names(attributes), names(uniforms)].concat(),
            Place::Attribute => [names(attributes), names(uniforms)].concat(),
            Place::Uniform => [names(uniforms), names(attributes)].concat(),
        };
        match nearest_name(name, &known) {
            Some(nearest) => self.help_for_nearest(nearest, place, &locals),
            None if place == Place::Uniform && uniforms.is_empty() => {
                format!("declare it: `uniform {{ {name}: f32 }}`")
            }
            None if place == Place::Uniform => unknown_name::help(name, &names(uniforms)),
            None if place == Place::Attribute => unknown_name::help(name, &names(attributes)),
            None if locals.is_empty() => "declare it with `let`".to_owned(),
            None => unknown_name::help(name, &locals),
        }
    }

    fn help_for_nearest(&self, nearest: &str, place: Place, locals: &[&str]) -> String {
        let is_of = |list: &[(String, Type)]| list.iter().any(|(other, _)| other == nearest);
        let (is_attribute, is_uniform) = (is_of(&self.environment.attributes), is_of(&self.environment.uniforms));
        let prefix = match place {
            Place::Value if locals.contains(&nearest) => None,
            Place::Attribute if is_attribute => None,
            Place::Uniform if is_uniform => None,
            _ if is_attribute => Some((self.owner(Type::Fragment), self.write_attribute(nearest))),
            _ => Some((self.owner(Type::Uniforms), self.write_uniform(nearest))),
        };
        match prefix {
            None => format!("did you mean `{nearest}`?"),
            Some((Some(owner), _)) => format!("did you mean `{owner}.{nearest}`?"),
            Some((None, write)) => format!("did you mean `{nearest}`? {write}"),
        }
    }

    /// Returns the help for the usual name of a parameter that the function does not have.
    fn help_for_parameter(&self, name: &str) -> Option<String> {
        match (name, self.owner(Type::Fragments)) {
            ("u" | "uniforms", _) if self.owner(Type::Uniforms).is_none() => {
                let declare = match self.environment.uniforms.is_empty() {
                    true => "declare `uniform { cut: f32 }` in the buffer, and ",
                    false => "declare ",
                };
                Some(format!("{declare}the uniforms as a parameter: {}", self.parameters_with(name)))
            }
            ("f" | "fragment" | "frag", Some(list)) => {
                Some(format!("iterate over the fragments: `for {name} in {list} {{ … }}`, or take one: `{list}[0]`"))
            }
            ("fragments", None) if !self.is_helper => {
                let help = "only `resolve` has all fragments; this closure is called for each of them";
                Some(help.to_owned())
            }
            _ => None,
        }
    }

    /// Returns how a closure writes an attribute.
    fn write_attribute(&self, name: &str) -> String {
        match (self.owner(Type::Fragment), self.owner(Type::Fragments)) {
            (Some(owner), _) => format!("write `{owner}.{name}`"),
            (None, Some(list)) => {
                format!("write `{list}[0].{name}`, or `f.{name}` in a loop `for f in {list} {{ … }}`")
            }
            (None, None) if self.is_helper => format!("add a parameter `f: Fragment`, and write `f.{name}`"),
            (None, None) => format!("write `f.{name}` for a fragment `f`"),
        }
    }

    /// Returns how a closure writes a uniform.
    fn write_uniform(&self, name: &str) -> String {
        match self.owner(Type::Uniforms) {
            Some(owner) => format!("write `{owner}.{name}`"),
            None => format!("add a parameter, {}, and write `u.{name}`", self.parameters_with("u")),
        }
    }

    /// Returns the parameters of the function with one for uniforms.
    fn parameters_with(&self, uniforms: &str) -> String {
        if self.is_helper {
            return format!("`{uniforms}: Uniforms`");
        }
        let first = self.variables.first().map_or("f", |first| first.name.as_str());
        format!("`|{first}, {uniforms}|`")
    }

    /// Returns the innermost variable of this type in scope.
    fn owner(&self, ty: Type) -> Option<&str> {
        let innermost_first = self.scopes.iter().rev().flat_map(|scope| scope.iter().rev());
        let of_type = innermost_first.into_iter().filter(|(_, id)| {
            self.variables.get(*id).is_some_and(|variable| self.inference.resolve(variable.ty) == ty)
        });
        of_type.map(|(name, _)| name.as_str()).next()
    }

    /// Returns the names of the variables in scope.
    fn locals(&self) -> Vec<&str> {
        let mut locals: Vec<&str> = Vec::new();
        for (name, _) in self.scopes.iter().flatten() {
            if !locals.contains(&name.as_str()) {
                locals.push(name);
            }
        }
        locals
    }
}

fn names_of(list: &[(String, Type)]) -> Vec<&str> {
    list.iter().map(|(name, _)| name.as_str()).collect()
}
