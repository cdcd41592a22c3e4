//! The textures of a description, from the images of `--texture`.
//!
//! Input: the options, and the textures that a description declares. Output: texels, four floats each: channels of an image from 0 to 1, as
//! stored. A texture of three dimensions is an image whose slices are one below the other, or a table that is computed from an image.

use fragbuf::{TextureDimension, Variant};
use fragbuf_frame::MAX_TEXTURE_SIDE;
use fragbuf_model::nearest_name;
#[cfg(feature = "gpu")]
use fragbuf_runtime::wgpu;

use super::request::RenderTask;
use super::{preintegrated, rendered};
use crate::cli::image_file::{ImageFile, read_image};
use crate::cli::memory::Budget;
use crate::cli::output::Failure;
use crate::cli::rendered_texture::RenderedTexture;

/// The texels of a texture of a description.
pub(super) struct TextureData {
    /// The name in the description.
    pub(super) name: String,
    /// Columns, rows and slices.
    pub(super) size: [u32; 3],
    /// Row after row from the top, slice after slice.
    pub(super) texels: Vec<[f32; 4]>,
}

/// Returns the textures of a description, and the memory that is left beside them.
pub(super) fn read(task: &RenderTask<'_>, mut memory: Budget) -> Result<(Vec<TextureData>, Budget), Failure> {
    let (variant, given) = (task.variant, &task.view.textures);
    let mut textures = Vec::new();
    for texture in &variant.textures {
        let name = &texture.name.value;
        let Some((_, source)) = given.iter().rfind(|(given, _)| given == name) else {
            let example = match texture.dimension.value {
                TextureDimension::D2 => "FILE.png",
                TextureDimension::D3 => "FILE.png,slices=N",
            };
            let message = format!("the description reads the texture `{name}`: add `--texture {name}={example}`");
            return Err(Failure::Usage(message));
        };
        if let Some(rendered) = RenderedTexture::parse(name, source) {
            let (data, rest) = rendered_data(&rendered?, texture.dimension.value, task, memory)?;
            memory = rest;
            textures.push(data);
            continue;
        }
        let source = Source::parse(name, source)?;
        let (data, rest) = source.read(name, texture.dimension.value, memory)?;
        memory = rest;
        textures.push(data);
    }
    Ok((textures, memory))
}

/// Draws a texture by another description.
fn rendered_data(
    rendered: &RenderedTexture,
    dimension: TextureDimension,
    task: &RenderTask<'_>,
    memory: Budget,
) -> Result<(TextureData, Budget), Failure> {
    let (name, (width, height)) = (&rendered.name, rendered.size);
    if dimension != TextureDimension::D2 {
        return Err(Failure::Usage(format!("`--texture {name}`: a picture has two dimensions: declare `{name}: 2d`")));
    }
    // The picture, and the texture of a device.
    let bytes = u64::from(width) * u64::from(height) * 2 * size_of::<[f32; 4]>() as u64;
    let memory = memory.without(bytes, "the texture that another description draws")?;
    let texels = rendered::draw(rendered, task, memory)?;
    Ok((TextureData { name: name.clone(), size: [width, height, 1], texels }, memory))
}

/// Rejects textures that none of the descriptions declares.
pub(in crate::cli) fn check_names(variants: &[&Variant], given: &[(String, String)]) -> Result<(), Failure> {
    let textures = variants.iter().flat_map(|variant| &variant.textures);
    let names: Vec<&str> = textures.map(|texture| texture.name.value.as_str()).collect();
    let Some((name, _)) = given.iter().find(|(name, _)| !names.contains(&name.as_str())) else { return Ok(()) };
    let known = match (nearest_name(name, &names), names.is_empty()) {
        (_, true) => "it declares none: `texture { lut: 2d }`".to_owned(),
        (Some(nearest), false) => format!("did you mean `{nearest}`? it has {}", names.join(", ")),
        (None, false) => format!("it has {}", names.join(", ")),
    };
    Err(Failure::Usage(format!("the description has no texture `{name}`: {known}")))
}

/// What gives the texels of a texture: `FILE.png`, `FILE.png,slices=N`, `preintegrated:FILE.png,…`, and
/// `preintegrated:builtin:NAME,…`.
struct Source<'a> {
    path: &'a str,
    options: Vec<(&'a str, &'a str)>,
    is_table: bool,
}

impl<'a> Source<'a> {
    fn parse(name: &str, text: &'a str) -> Result<Self, Failure> {
        let (text, is_table) = match text.strip_prefix("preintegrated:") {
            Some(rest) => (rest, true),
            None => (text, false),
        };
        let mut parts = text.split(',');
        let path = parts.next().unwrap_or_default();
        let option = |part: &'a str| {
            part.split_once('=')
                .ok_or_else(|| Failure::Usage(format!("`--texture {name}`: write options as name=value, not `{part}`")))
        };
        Ok(Source { path, options: parts.map(option).collect::<Result<_, _>>()?, is_table })
    }

    fn read(&self, name: &str, dimension: TextureDimension, memory: Budget) -> Result<(TextureData, Budget), Failure> {
        let usage = |message: String| Failure::Usage(format!("`--texture {name}`: {message}"));
        if self.is_table {
            let settings = preintegrated::Settings::parse(&self.options).map_err(usage)?;
            let transfer = match preintegrated::builtin(self.path).transpose().map_err(usage)? {
                Some(transfer) => transfer,
                None => read_image(self.path.as_ref(), memory).map(|image| image.first_row())?,
            };
            if dimension != TextureDimension::D3 {
                return Err(usage(format!("a pre-integrated table has three dimensions: declare `{name}: 3d`")));
            }
            let memory = memory.without(settings.bytes(), "a pre-integrated table")?;
            let (size, texels) = preintegrated::table(&transfer, &settings);
            return Ok((TextureData { name: name.to_owned(), size, texels }, memory));
        }
        let image = read_image(self.path.as_ref(), memory)?;
        let slices = self.slices(name, dimension, &image)?;
        let ImageFile { size: (width, height), texels, memory } = image;
        Ok((TextureData { name: name.to_owned(), size: [width, height / slices, slices], texels }, memory))
    }

    /// Returns the number of slices of an image.
    fn slices(&self, name: &str, dimension: TextureDimension, image: &ImageFile) -> Result<u32, Failure> {
        let usage = |message: String| Failure::Usage(format!("`--texture {name}`: {message}"));
        let mut slices = None;
        for (option, value) in &self.options {
            let number = value.parse::<u32>().ok().filter(|number| (1..=MAX_TEXTURE_SIDE).contains(number));
            match (*option, number) {
                ("slices", Some(number)) => slices = Some(number),
                ("slices", None) => return Err(usage(format!("`slices` takes a number from 1 to {MAX_TEXTURE_SIDE}"))),
                _ => return Err(usage(format!("an image has no option `{option}`: it has slices"))),
            }
        }
        let height = image.size.1;
        match (dimension, slices) {
            (TextureDimension::D2, None) => Ok(1),
            (TextureDimension::D2, Some(_)) => {
                Err(usage(format!("`slices` is for textures of three dimensions, and `{name}` has two")))
            }
            (TextureDimension::D3, None) => Err(usage(format!(
                "`{name}` has three dimensions: add `,slices=N`, the number of slices one below the other in the image"
            ))),
            (TextureDimension::D3, Some(slices)) if !height.is_multiple_of(slices) => {
                Err(usage(format!("the image has {height} rows, which {slices} slices do not divide")))
            }
            (TextureDimension::D3, Some(slices)) => Ok(slices),
        }
    }
}

/// Creates the textures of a description on a device.
#[cfg(feature = "gpu")]
pub(super) fn upload(
    variant: &Variant,
    textures: &[TextureData],
    device: &wgpu::Device,
    queue: &wgpu::Queue,
) -> Result<Vec<(String, wgpu::Texture)>, Failure> {
    let one = |(data, declared): (&TextureData, &fragbuf::Texture)| {
        Ok((data.name.clone(), data.upload(device, queue, declared.dimension.value)?))
    };
    textures.iter().zip(&variant.textures).map(one).collect()
}

#[cfg(feature = "gpu")]
impl TextureData {
    /// Creates a texture of the dimension that the description declares. `Err`: the device does not allow the size.
    pub(super) fn upload(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        declared: TextureDimension,
    ) -> Result<wgpu::Texture, Failure> {
        let [width, height, depth_or_array_layers] = self.size;
        let size = wgpu::Extent3d { width, height, depth_or_array_layers };
        let (dimension, most) = match declared {
            TextureDimension::D2 => (wgpu::TextureDimension::D2, device.limits().max_texture_dimension_2d),
            TextureDimension::D3 => (wgpu::TextureDimension::D3, device.limits().max_texture_dimension_3d),
        };
        if self.size.iter().any(|length| *length > most) {
            let [width, height, slices] = self.size;
            return Err(Failure::Device(format!(
                "the texture `{}` has {width} x {height} x {slices} texels, and the device allows {most} along each side",
                self.name
            )));
        }
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(&self.name),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let bytes: Vec<u8> = self.texels.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(16 * size.width),
            rows_per_image: Some(size.height),
        };
        queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
        Ok(texture)
    }
}
