//! The state of one printing run.
//!
//! In: the module and the options. It carries the names of all global things, collects what the printed bodies turn out
//! to need (types, constants, globals, helper functions, extensions) and every error. It never prints anything itself.

use std::collections::{BTreeMap, BTreeSet};

use naga::valid::ModuleInfo;
use naga::{Constant, Function, GlobalVariable, Handle, Module, Span, Type};

use crate::helpers::Helper;
use crate::names::{GlobalNames, global_names};
use crate::{Dialect, Marker, Options, Unprintable};

/// What the bodies printed so far make it necessary to declare.
#[derive(Default)]
pub struct Needs {
    pub types: BTreeSet<Handle<Type>>,
    pub constants: BTreeSet<Handle<Constant>>,
    pub globals: BTreeSet<Handle<GlobalVariable>>,
    pub helpers: BTreeSet<Helper>,
    pub extensions: BTreeSet<&'static str>,
    /// The layout qualifier that the interlock needs, if it is used.
    pub interlock: Option<&'static str>,
    /// OpenGL: the one sampler that each sampled texture is combined with, and whether it compares.
    pub combined: BTreeMap<Handle<GlobalVariable>, (Handle<GlobalVariable>, bool)>,
}

pub struct Printer<'a> {
    pub module: &'a Module,
    pub info: &'a ModuleInfo,
    pub source: &'a str,
    pub options: &'a Options<'a>,
    pub names: GlobalNames,
    pub needs: Needs,
    /// Whether the text will have a `main`.
    pub has_main: bool,
    pub comments: crate::comments::Comments<'a>,
    errors: Vec<Unprintable>,
}

impl<'a> Printer<'a> {
    pub fn new(module: &'a Module, info: &'a ModuleInfo, source: &'a str, options: &'a Options<'a>) -> Self {
        Self {
            module,
            info,
            source,
            options,
            names: global_names(module),
            needs: Needs::default(),
            has_main: false,
            comments: crate::comments::Comments::new(source),
            errors: Vec::new(),
        }
    }

    /// Notes something unprintable and stands in for its text, so that one run finds all errors.
    pub fn error(&mut self, what: impl Into<String>, span: Span) -> String {
        let error = Unprintable { what: what.into(), span };
        if !self.errors.contains(&error) {
            self.errors.push(error);
        }
        "unprintable".to_owned()
    }

    pub fn finish(self, text: String) -> Result<String, Vec<Unprintable>> {
        if self.errors.is_empty() { Ok(text) } else { Err(self.errors) }
    }

    pub fn vulkan(&self) -> bool {
        self.options.dialect == Dialect::Vulkan450
    }

    pub fn es(&self) -> bool {
        self.options.dialect == Dialect::Es310
    }

    /// What the function stands for, if it is a marker.
    pub fn marker(&self, function: Handle<Function>) -> Option<Marker> {
        let name = self.module.functions[function].name.as_deref()?;
        self.options.markers.iter().find(|(marked, _)| *marked == name).map(|(_, marker)| *marker)
    }

    pub fn helper(&mut self, helper: Helper) -> String {
        self.needs.helpers.insert(helper);
        helper.name().to_owned()
    }
}
