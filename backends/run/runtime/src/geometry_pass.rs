//! What a pipeline of the caller needs in a geometry pass, in module form.
//!
//! Input: the shaders of a plan in module form. Output: one [`GeometryPass`] per pass that the caller serves.

use fragbuf_codegen::PlannedPass;
use fragbuf_templates::vocabulary::Kind;

use crate::fixed_function::fixed_functions;
use crate::{Error, Renderer, Shaders};

/// The function of a geometry pass in module form, which the caller's shader calls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModuleFunction {
    /// The pass.
    pub pass: String,
    /// The name with the prefix: `store_fragment`.
    pub name: String,
    /// The WGSL that declares the function and the struct `Fragment`.
    pub source: String,
}

/// A geometry pass that the caller serves with a pipeline of its own. [`Renderer::bind_group_layout`] has its layout.
#[derive(Clone, Debug, PartialEq)]
pub struct GeometryPass {
    /// The name, as in the pass of [`Call`](crate::Call).
    pub name: String,
    /// The function to call at the end of the caller's fragment shader.
    pub function: String,
    /// The WGSL to put in front of the caller's shader.
    pub source: String,
    /// The colour targets. The shader writes to none of them.
    pub targets: Vec<Option<wgpu::ColorTargetState>>,
    /// Depth and stencil tests.
    pub depth_stencil: Option<wgpu::DepthStencilState>,
    /// Samples per pixel and the sample mask.
    pub multisample: wgpu::MultisampleState,
}

impl GeometryPass {
    /// Returns what the caller needs to serve `pass`; `None` if the runtime has its pipeline.
    pub(crate) fn of(
        shaders: &Shaders,
        pass: &PlannedPass,
        output: wgpu::TextureFormat,
    ) -> Result<Option<Self>, Error> {
        let function = shaders.functions.iter().find(|function| function.pass == pass.name);
        let Some(function) = function.filter(|_| pass.kind == Kind::Geometry) else { return Ok(None) };
        // Only plans with entry points of their own have a sample mask for each iteration.
        let fixed = fixed_functions(&shaders.plan, pass, output, 1)?.pop();
        Ok(fixed.map(|fixed| GeometryPass {
            name: pass.name.clone(),
            function: function.name.clone(),
            source: function.source.clone(),
            targets: fixed.targets,
            depth_stencil: fixed.depth_stencil,
            multisample: fixed.multisample,
        }))
    }
}

impl Renderer {
    /// Returns the geometry passes whose pipelines the caller sets in its draw function, in the order of a frame. A plan in program
    /// form has none.
    pub fn geometry_passes(&self) -> impl Iterator<Item = &GeometryPass> {
        self.pipeline_set().passes.iter().filter_map(|prepared| prepared.callers.as_ref())
    }
}
