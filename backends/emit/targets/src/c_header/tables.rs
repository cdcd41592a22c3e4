//! Writes the tables of resources, passes, files and counters.

use fragbuf_templates::COUNTERS;
use fragbuf_templates::vocabulary::{Element, Init, Kind, Lifetime, Objects, TextureDimension, TextureFormat};

use super::Writer;
use super::names::string;
use crate::generate::{Generation, PlanForTargets};
use crate::manifest::frame::access;

impl Writer<'_> {
    /// Writes the tables, and returns their names and lengths in the order of `struct fragbuf_plan`.
    pub(super) fn tables(&mut self, planned: &PlanForTargets, generation: &Generation) -> Vec<(String, usize)> {
        let resources = self.resources();
        let exchanges = self.exchanges();
        let passes = self.passes();
        let files = self.files(planned, generation);
        let (loops, hosts) = (self.loops(), self.hosts());
        let counters = self.counters();
        let steps = self.steps();
        vec![resources, exchanges, passes, files, loops, hosts, counters, steps]
    }

    fn resources(&mut self) -> (String, usize) {
        self.text.push_str("\n/* Indices of resources, and their bindings. */\n");
        for (index, planned) in (0..).zip(&self.plan.resources) {
            let name = &planned.resource.name;
            self.constant(&format!("resource_{name}"), index, &planned.resource.summary);
            self.constant(&format!("{name}_binding"), planned.binding, &format!("the binding of `{name}`"));
        }
        let mut rows = Vec::new();
        for planned in &self.plan.resources {
            let resource = &planned.resource;
            let bytes = self.function(&format!("{}_bytes", resource.name), 4, &planned.words);
            let init = match resource.init {
                Init::Clear(_) => "FRAGBUF_CLEARED",
                Init::Keep => "FRAGBUF_KEPT",
                Init::External => "FRAGBUF_EXTERNAL",
            };
            let format = match resource.element {
                Element::Texture(format) | Element::ValueTextures(format) | Element::EntryTextures(format) => {
                    enumerator(format)
                }
                Element::Texels(dimension) => match dimension {
                    TextureDimension::D2 => "FRAGBUF_TEXELS_2D",
                    TextureDimension::D3 => "FRAGBUF_TEXELS_3D",
                },
                Element::Word | Element::Word64 | Element::Entry | Element::Value => "FRAGBUF_BUFFER",
            };
            let is_persistent = u32::from(resource.lifetime == Lifetime::Persistent);
            let (name, binding, opengl) =
                (string(&resource.name), planned.binding, self.opengl_binding(planned.binding));
            rows.push(format!("{{{name}, {binding}, {opengl}, {format}, {init}, {is_persistent}, {bytes}}},"));
        }
        self.table("struct fragbuf_resource", "resources", &rows)
    }

    fn passes(&mut self) -> (String, usize) {
        self.text.push_str("\n/* Indices of passes. */\n");
        for (index, pass) in (0..).zip(&self.plan.passes) {
            self.constant(&format!("pass_{}", pass.name), index, &format!("the pass `{}`", pass.name));
        }
        let mut rows = Vec::new();
        for pass in &self.plan.passes {
            let mut groups = ["NULL"; 3].map(str::to_owned);
            for ((group, axis), formula) in groups.iter_mut().zip(["x", "y", "z"]).zip(&pass.groups) {
                *group = self.function(&format!("{}_groups_{axis}", pass.name), 1, formula);
            }
            // A use that the plan does not declare is of a texture of the device, such as the output.
            let uses = pass.uses.iter().filter_map(|used| Some((self.plan.resource_id(&used.resource)?.0, used)));
            let uses: Vec<String> = uses
                .map(|(index, used)| format!("{{{index}, \"{}\"}}, /* {} */", access(used.access), used.resource))
                .collect();
            let (uses, count) = self.table("struct fragbuf_use", &format!("{}_uses", pass.name), &uses);
            let kind = match &pass.kind {
                Kind::Geometry => "FRAGBUF_GEOMETRY",
                Kind::Fullscreen => "FRAGBUF_FULLSCREEN",
                Kind::Compute { .. } => "FRAGBUF_COMPUTE",
            };
            let (objects, query) = match &pass.objects {
                Objects::All => ("FRAGBUF_ALL_OBJECTS", 0),
                Objects::Boxes => ("FRAGBUF_BOXES", 0),
                Objects::Visible(query) => {
                    ("FRAGBUF_VISIBLE_OBJECTS", self.plan.pass_id(query).map_or(0, |query| query.0))
                }
            };
            let (name, groups) = (string(&pass.name), groups.join(", "));
            rows.push(format!("{{{name}, {kind}, {objects}, {query}, {{{groups}}}, {uses}, {count}}},"));
        }
        self.table("struct fragbuf_pass", "passes", &rows)
    }

    fn files(&mut self, planned: &PlanForTargets, generation: &Generation) -> (String, usize) {
        let is_of_plan = |target: &str| planned.targets.iter().any(|other| other.name == target);
        let mut rows = Vec::new();
        for file in generation.files.iter().filter(|file| is_of_plan(file.target)) {
            let Some(pass) = self.plan.pass_id(&file.pass) else { continue };
            for (stage, entry_point) in &file.entry_points {
                let [path, target, stage, entry_point] =
                    [file.path.as_str(), file.target, *stage, entry_point.as_str()].map(string);
                rows.push(format!("{{{path}, {target}, {stage}, {entry_point}, {}}},", pass.0));
            }
        }
        self.table("struct fragbuf_file", "files", &rows)
    }

    fn counters(&mut self) -> (String, usize) {
        if self.plan.resource_id("counters").is_none() {
            return ("NULL".to_owned(), 0);
        }
        self.text.push_str("\n/* Words of the resource `counters`. */\n");
        let mut rows = Vec::new();
        for (index, (name, kind, meaning)) in (0..).zip(COUNTERS) {
            self.constant(&format!("counter_{name}"), index, meaning);
            let is_loss = u32::from(kind.makes_image_wrong());
            rows.push(format!("{{{}, {}, {is_loss}}},", string(name), string(meaning)));
        }
        self.table("struct fragbuf_counter", "counters", &rows)
    }
}

fn enumerator(format: TextureFormat) -> &'static str {
    match format {
        TextureFormat::R32Uint => "FRAGBUF_R32_UINT",
        TextureFormat::Rg16Uint => "FRAGBUF_RG16_UINT",
        TextureFormat::R32Float => "FRAGBUF_R32_FLOAT",
        TextureFormat::Rg32Float => "FRAGBUF_RG32_FLOAT",
        TextureFormat::Rgba8Unorm => "FRAGBUF_RGBA8_UNORM",
        TextureFormat::Rgba16Float => "FRAGBUF_RGBA16_FLOAT",
        TextureFormat::Depth32Float => "FRAGBUF_DEPTH32_FLOAT",
        TextureFormat::Depth24PlusStencil8 => "FRAGBUF_DEPTH24_PLUS_STENCIL8",
    }
}
