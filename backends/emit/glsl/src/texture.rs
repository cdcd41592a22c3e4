//! Prints texture samples, loads, stores and queries.
//!
//! The Vulkan dialect has separate textures and samplers, as WGSL does. OpenGL has combined samplers only: a texture is
//! combined with the one sampler that it is used with. A texture with several samplers cannot be printed.

use naga::{
    Expression, GlobalVariable, Handle, ImageClass, ImageDimension, ImageQuery, SampleLevel, ScalarKind, TypeInner,
};

use crate::function::FunctionPrinter;
use crate::precedence::Text;

const SAMPLERLESS: &str = "GL_EXT_samplerless_texture_functions";

/// A texture variable and its type.
struct Image {
    global: Handle<GlobalVariable>,
    dimension: ImageDimension,
    arrayed: bool,
    class: ImageClass,
}

/// The parts of an `ImageSample` expression.
struct Sample {
    coordinate: Handle<Expression>,
    array_index: Option<Handle<Expression>>,
    offset: Option<Handle<Expression>>,
    level: SampleLevel,
    depth_ref: Option<Handle<Expression>>,
    gather: Option<naga::SwizzleComponent>,
}

impl FunctionPrinter<'_, '_> {
    /// Returns the texture variable of an expression.
    fn image(&mut self, image: Handle<Expression>) -> Option<Image> {
        let Expression::GlobalVariable(global) = self.function.expressions[image] else {
            self.error("a texture passed as an argument", image);
            return None;
        };
        let ty = self.printer.module.global_variables[global].ty;
        let TypeInner::Image { dim, arrayed, class } = self.printer.module.types[ty].inner else {
            self.error("a texture of this type", image);
            return None;
        };
        self.printer.requirements.globals.insert(global);
        Some(Image { global, dimension: dim, arrayed, class })
    }

    /// Prints a sample, load or query.
    pub fn texture(&mut self, expression: Handle<Expression>) -> Text {
        let text = match self.function.expressions[expression] {
            Expression::ImageSample {
                image,
                sampler,
                gather,
                coordinate,
                array_index,
                offset,
                level,
                depth_ref,
                clamp_to_edge,
            } => {
                if clamp_to_edge {
                    self.error("textureSampleBaseClampToEdge", expression);
                }
                self.sample(image, sampler, &Sample { coordinate, array_index, offset, level, depth_ref, gather })
            }
            Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
                self.image_load(image, coordinate, array_index, sample, level)
            }
            Expression::ImageQuery { image, query } => self.image_query(expression, image, query),
            _ => None,
        };
        Text::primary(text.unwrap_or_default())
    }

    /// Returns the printed name of a variable.
    fn name(&self, global: Handle<GlobalVariable>) -> String {
        self.printer.names.globals.get(&global).cloned().unwrap_or_default()
    }

    /// Prints the texture and its sampler as one value that GLSL can sample.
    fn combined(&mut self, image: &Image, sampler: Handle<Expression>) -> Option<String> {
        let Expression::GlobalVariable(sampler_global) = self.function.expressions[sampler] else {
            self.error("a sampler passed as an argument", sampler);
            return None;
        };
        let ty = self.printer.module.global_variables[sampler_global].ty;
        let comparison = matches!(self.printer.module.types[ty].inner, TypeInner::Sampler { comparison: true });
        let texture = self.name(image.global);
        if self.printer.vulkan() {
            self.printer.requirements.globals.insert(sampler_global);
            let ty = opaque_type("sampler", image.dimension, image.arrayed, image.class);
            let shadow = if comparison { "Shadow" } else { "" };
            return Some(format!("{ty}{shadow}({texture}, {})", self.name(sampler_global)));
        }
        let before = self.printer.requirements.combined.insert(image.global, (sampler_global, comparison));
        if before.is_some_and(|(other, _)| other != sampler_global) {
            self.error("one texture with several samplers, in OpenGL", sampler);
        }
        Some(texture)
    }

    /// Prints a sample.
    fn sample(&mut self, image: Handle<Expression>, sampler: Handle<Expression>, sample: &Sample) -> Option<String> {
        let image = self.image(image)?;
        let texture = self.combined(&image, sampler)?;
        let depth = matches!(image.class, ImageClass::Depth { .. });
        let mut arguments = vec![texture, self.coordinate(&image, sample)];
        let separate_reference = sample.gather.is_some() || (image.dimension == ImageDimension::Cube && image.arrayed);
        if let (Some(reference), true) = (sample.depth_ref, separate_reference) {
            arguments.push(self.expression(reference));
        }
        if let Some(component) = sample.gather {
            arguments.extend(sample.offset.map(|offset| self.expression(offset)));
            if sample.depth_ref.is_none() {
                arguments.push((component as u32).to_string());
            }
            let name = if sample.offset.is_some() { "textureGatherOffset" } else { "textureGather" };
            return Some(format!("{name}({})", arguments.join(", ")));
        }
        let stem = match sample.level {
            SampleLevel::Auto | SampleLevel::Bias(_) => "texture",
            SampleLevel::Zero | SampleLevel::Exact(_) => "textureLod",
            SampleLevel::Gradient { .. } => "textureGrad",
        };
        match sample.level {
            SampleLevel::Zero => arguments.push("0.0".to_owned()),
            SampleLevel::Exact(level) => arguments.push(self.level(level)),
            SampleLevel::Gradient { x, y } => arguments.extend([self.expression(x), self.expression(y)]),
            SampleLevel::Auto | SampleLevel::Bias(_) => {}
        }
        arguments.extend(sample.offset.map(|offset| self.expression(offset)));
        if let SampleLevel::Bias(bias) = sample.level {
            arguments.push(self.expression(bias));
        }
        let name = if sample.offset.is_some() { format!("{stem}Offset") } else { stem.to_owned() };
        let text = format!("{name}({})", arguments.join(", "));
        // GLSL samples a depth texture without comparison as a vector.
        Some(if depth && sample.depth_ref.is_none() { format!("{text}.x") } else { text })
    }

    /// Prints a level as a float. WGSL allows an integer level for depth textures.
    fn level(&mut self, level: Handle<Expression>) -> String {
        let text = self.expression(level);
        let float = self.shape(level).is_none_or(|(_, scalar)| scalar.kind == ScalarKind::Float);
        if float { text } else { format!("float({text})") }
    }

    /// Prints position, layer and, if GLSL packs it into the same vector, the reference depth.
    fn coordinate(&mut self, image: &Image, sample: &Sample) -> String {
        let coordinate = self.expression(sample.coordinate);
        let layer = sample.array_index.map(|layer| format!("float({})", self.expression(layer)));
        let packs = sample.gather.is_none() && !(image.dimension == ImageDimension::Cube && image.arrayed);
        let reference = sample.depth_ref.filter(|_| packs).map(|reference| self.expression(reference));
        let lanes = match image.dimension {
            ImageDimension::D1 => 1,
            ImageDimension::D2 => 2,
            _ => 3,
        };
        let extra: Vec<String> = layer.into_iter().chain(reference).collect();
        if extra.is_empty() {
            return coordinate;
        }
        format!("vec{}({coordinate}, {})", lanes + extra.len(), extra.join(", "))
    }

    /// Prints an integer position with the layer.
    fn texel(&mut self, image: &Image, coordinate: Handle<Expression>, layer: Option<Handle<Expression>>) -> String {
        let lanes = self.shape(coordinate).map_or(1, |(lanes, _)| lanes);
        let signed = self.shape(coordinate).is_some_and(|(_, scalar)| scalar.kind == ScalarKind::Sint);
        let text = self.expression(coordinate);
        let Some(layer) = layer.filter(|_| image.arrayed) else {
            let ty = if lanes == 1 { "int".to_owned() } else { format!("ivec{lanes}") };
            return if signed { text } else { format!("{ty}({text})") };
        };
        let layer = self.expression(layer);
        format!("ivec{}({text}, {layer})", lanes + 1)
    }

    /// Prints an integer as `int`.
    fn int(&mut self, value: Handle<Expression>) -> String {
        let signed = self.shape(value).is_some_and(|(_, scalar)| scalar.kind == ScalarKind::Sint);
        let text = self.expression(value);
        if signed || text.parse::<u32>().is_ok() { text } else { format!("int({text})") }
    }

    /// Prints a load from a texture or storage texture.
    fn image_load(
        &mut self,
        image: Handle<Expression>,
        coordinate: Handle<Expression>,
        array_index: Option<Handle<Expression>>,
        sample: Option<Handle<Expression>>,
        level: Option<Handle<Expression>>,
    ) -> Option<String> {
        let image = self.image(image)?;
        let texture = self.name(image.global);
        let texel = self.texel(&image, coordinate, array_index);
        if let ImageClass::Storage { .. } = image.class {
            return Some(format!("imageLoad({texture}, {texel})"));
        }
        if self.printer.vulkan() {
            self.printer.requirements.extensions.insert(SAMPLERLESS);
        }
        let last = match sample.or(level) {
            Some(last) => self.int(last),
            None => "0".to_owned(),
        };
        let text = format!("texelFetch({texture}, {texel}, {last})");
        Some(if matches!(image.class, ImageClass::Depth { .. }) { format!("{text}.x") } else { text })
    }

    /// Prints a store to a storage texture.
    pub fn image_store(
        &mut self,
        image: Handle<Expression>,
        coordinate: Handle<Expression>,
        array_index: Option<Handle<Expression>>,
        value: Handle<Expression>,
    ) -> String {
        let Some(image) = self.image(image) else { return String::new() };
        let texture = self.name(image.global);
        let texel = self.texel(&image, coordinate, array_index);
        let value = self.expression(value);
        format!("imageStore({texture}, {texel}, {value})")
    }

    /// Prints a query of size, levels, layers or samples.
    fn image_query(
        &mut self,
        expression: Handle<Expression>,
        image: Handle<Expression>,
        query: ImageQuery,
    ) -> Option<String> {
        let image = self.image(image)?;
        let texture = self.name(image.global);
        let storage = matches!(image.class, ImageClass::Storage { .. });
        let multisampled =
            matches!(image.class, ImageClass::Sampled { multi: true, .. } | ImageClass::Depth { multi: true });
        if self.printer.vulkan() && !storage {
            self.printer.requirements.extensions.insert(SAMPLERLESS);
        }
        let size = if storage {
            format!("imageSize({texture})")
        } else if multisampled {
            format!("textureSize({texture})")
        } else {
            let level = match query {
                ImageQuery::Size { level: Some(level) } => self.int(level),
                _ => "0".to_owned(),
            };
            format!("textureSize({texture}, {level})")
        };
        Some(match query {
            ImageQuery::Size { .. } => {
                let ty = self.type_name(expression);
                let swizzle = if image.arrayed { ".xy" } else { "" };
                format!("{ty}({size}{swizzle})")
            }
            ImageQuery::NumLevels | ImageQuery::NumSamples if self.printer.es() => {
                self.error("a texture's number of levels or samples", expression)
            }
            ImageQuery::NumLevels => format!("uint(textureQueryLevels({texture}))"),
            ImageQuery::NumLayers => format!("uint({size}.z)"),
            ImageQuery::NumSamples => format!("uint(textureSamples({texture}))"),
        })
    }
}

/// Returns the prefix of a texture type: `u`, `i` or nothing.
fn prefix(class: ImageClass) -> &'static str {
    let kind = match class {
        ImageClass::Sampled { kind, .. } => kind,
        ImageClass::Storage { format, .. } => naga::Scalar::from(format).kind,
        _ => ScalarKind::Float,
    };
    match kind {
        ScalarKind::Uint => "u",
        ScalarKind::Sint => "i",
        _ => "",
    }
}

/// Returns the suffix of a texture type, such as `2DMSArray`.
fn type_suffix(dimension: ImageDimension, arrayed: bool, class: ImageClass) -> String {
    let dimension = match dimension {
        ImageDimension::D1 => "1D",
        ImageDimension::D2 => "2D",
        ImageDimension::D3 => "3D",
        ImageDimension::Cube => "Cube",
    };
    let multisampled = matches!(class, ImageClass::Sampled { multi: true, .. } | ImageClass::Depth { multi: true });
    format!("{dimension}{}{}", if multisampled { "MS" } else { "" }, if arrayed { "Array" } else { "" })
}

/// Returns the GLSL type of a texture variable; `stem` is `sampler`, `texture` or `image`.
pub fn opaque_type(stem: &str, dimension: ImageDimension, arrayed: bool, class: ImageClass) -> String {
    format!("{}{stem}{}", prefix(class), type_suffix(dimension, arrayed, class))
}

/// Returns the format qualifier of a storage texture.
pub fn format_name(format: naga::StorageFormat) -> Option<&'static str> {
    use naga::StorageFormat as F;
    Some(match format {
        F::R8Unorm => "r8",
        F::R8Snorm => "r8_snorm",
        F::R8Uint => "r8ui",
        F::R8Sint => "r8i",
        F::R16Uint => "r16ui",
        F::R16Sint => "r16i",
        F::R16Float => "r16f",
        F::Rg8Unorm => "rg8",
        F::Rg8Snorm => "rg8_snorm",
        F::Rg8Uint => "rg8ui",
        F::Rg8Sint => "rg8i",
        F::R32Uint => "r32ui",
        F::R32Sint => "r32i",
        F::R32Float => "r32f",
        F::Rg16Uint => "rg16ui",
        F::Rg16Sint => "rg16i",
        F::Rg16Float => "rg16f",
        F::Rgba8Unorm => "rgba8",
        F::Rgba8Snorm => "rgba8_snorm",
        F::Rgba8Uint => "rgba8ui",
        F::Rgba8Sint => "rgba8i",
        F::Rgb10a2Uint => "rgb10_a2ui",
        F::Rgb10a2Unorm => "rgb10_a2",
        F::Rg11b10Ufloat => "r11f_g11f_b10f",
        F::Rg32Uint => "rg32ui",
        F::Rg32Sint => "rg32i",
        F::Rg32Float => "rg32f",
        F::Rgba16Uint => "rgba16ui",
        F::Rgba16Sint => "rgba16i",
        F::Rgba16Float => "rgba16f",
        F::Rgba32Uint => "rgba32ui",
        F::Rgba32Sint => "rgba32i",
        F::Rgba32Float => "rgba32f",
        F::R16Unorm => "r16",
        F::R16Snorm => "r16_snorm",
        F::Rg16Unorm => "rg16",
        F::Rg16Snorm => "rg16_snorm",
        F::Rgba16Unorm => "rgba16",
        F::Rgba16Snorm => "rgba16_snorm",
        F::Bgra8Unorm | F::R64Uint => return None,
    })
}
