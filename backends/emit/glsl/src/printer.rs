//! The shared state of printing one shader.
//!
//! Input: the module and the options. The state holds the names of all module-scope items and collects every error. It
//! also collects what the printed bodies use: types, constants, globals, helper functions and extensions. It prints nothing
//! itself.

use std::collections::{BTreeMap, BTreeSet};

use naga::valid::ModuleInfo;
use naga::{Constant, Function, GlobalVariable, Handle, Module, Span, Type};

use crate::helpers::Helper;
use crate::names::{GlobalNames, global_names};
use crate::options::{Dialect, Marker, Options, Unprintable};

/// The declarations that the bodies printed so far require.
#[derive(Default)]
pub struct Requirements {
    pub types: BTreeSet<Handle<Type>>,
    pub constants: BTreeSet<Handle<Constant>>,
    pub globals: BTreeSet<Handle<GlobalVariable>>,
    pub helpers: BTreeSet<Helper>,
    pub extensions: BTreeSet<&'static str>,
    /// The layout qualifier of the interlock, if a body uses it.
    pub interlock: Option<&'static str>,
    /// OpenGL: the one sampler that each sampled texture is combined with; true for a comparison sampler.
    pub combined: BTreeMap<Handle<GlobalVariable>, (Handle<GlobalVariable>, bool)>,
}

/// The state of printing one unit.
pub struct Printer<'a> {
    pub module: &'a Module,
    pub info: &'a ModuleInfo,
    pub source: &'a str,
    pub options: &'a Options<'a>,
    pub names: GlobalNames,
    pub requirements: Requirements,
    /// True if the printed source has a `main`.
    pub has_main: bool,
    pub comments: crate::comments::Comments<'a>,
    errors: Vec<Unprintable>,
}

impl<'a> Printer<'a> {
    /// Returns the initial state, with all module-scope items named.
    pub fn new(module: &'a Module, info: &'a ModuleInfo, source: &'a str, options: &'a Options<'a>) -> Self {
        Self {
            module,
            info,
            source,
            options,
            names: global_names(module),
            requirements: Requirements::default(),
            has_main: false,
            comments: crate::comments::Comments::new(source),
            errors: Vec::new(),
        }
    }

    /// Records an error and returns a substitute for the unprintable text, so that one run finds all errors.
    pub fn error(&mut self, message: impl Into<String>, span: Span) -> String {
        let error = Unprintable { message: message.into(), span };
        if !self.errors.contains(&error) {
            self.errors.push(error);
        }
        "unprintable".to_owned()
    }

    /// Returns the printed source, or all recorded errors.
    pub fn finish(self, text: String) -> Result<String, Vec<Unprintable>> {
        if self.errors.is_empty() { Ok(text) } else { Err(self.errors) }
    }

    /// Tests whether the dialect is Vulkan GLSL.
    pub fn vulkan(&self) -> bool {
        self.options.dialect == Dialect::Vulkan450
    }

    /// Tests whether the dialect is OpenGL ES.
    pub fn es(&self) -> bool {
        self.options.dialect == Dialect::Es310
    }

    /// Returns the marker that a function is, if any.
    pub fn marker(&self, function: Handle<Function>) -> Option<Marker> {
        let name = self.module.functions[function].name.as_deref()?;
        self.options.markers.iter().find(|(marked, _)| *marked == name).map(|(_, marker)| *marker)
    }

    /// Requires a helper function and returns its name.
    pub fn helper(&mut self, helper: Helper) -> String {
        self.requirements.helpers.insert(helper);
        helper.name().to_owned()
    }
}
