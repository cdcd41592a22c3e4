//! Compiles texture reads by column, row, and sample, slice or level, and texture queries.
//!
//! Only 2D and 3D textures are read. Filtering, layers and writes are unsupported.

use naga::{Expression, GlobalVariable, Handle, ImageClass, ImageDimension, ImageQuery, ScalarKind, TypeInner};

use super::compiler::{Compiler, Result, Value};
use crate::bytecode::Texture;
use crate::operation::{Op, Word};

impl Compiler<'_> {
    /// Declares a texture variable.
    pub(super) fn texture(&mut self, variable: &GlobalVariable) -> Result<Value> {
        let TypeInner::Image { dim, arrayed, class } = self.layouts.inner(variable.ty) else {
            return Err("samplers".to_owned());
        };
        if !matches!(dim, ImageDimension::D2 | ImageDimension::D3) || *arrayed {
            return Err("a texture that is not 2D or 3D".to_owned());
        }
        let is_3d = *dim == ImageDimension::D3;
        let (kind, is_depth, is_multisampled) = match class {
            ImageClass::Sampled { kind, multi } => (*kind, false, *multi),
            ImageClass::Depth { multi } => (ScalarKind::Float, true, *multi),
            ImageClass::Storage { .. } | ImageClass::External => return Err("storage and external textures".to_owned()),
        };
        let number = u16::try_from(self.textures.len()).map_err(|_| "more than 65536 textures".to_owned())?;
        let name = variable.name.clone().unwrap_or_default();
        let binding = variable.binding.map(|binding| (binding.group, binding.binding));
        self.textures.push(Texture { name, binding, kind, is_depth, is_multisampled, is_3d });
        Ok(Value::Texture(number))
    }

    /// Compiles `textureLoad`.
    pub(super) fn texel(
        &mut self,
        image: Handle<Expression>,
        coordinate: Handle<Expression>,
        number: Option<Handle<Expression>>,
    ) -> Result<Word> {
        let texture = self.texture_of(image)?;
        let coordinate = self.words(coordinate)?;
        let number = match number {
            Some(number) => self.words(number)?,
            None => self.constant(0),
        };
        let coordinates = self.take(3);
        if self.textures[usize::from(texture)].is_3d {
            self.push(Op::Copy { to: coordinates, from: coordinate, count: 3 });
        } else {
            self.push(Op::Copy { to: coordinates, from: coordinate, count: 2 });
            self.push(Op::Copy { to: coordinates + 2, from: number, count: 1 });
        }
        let count = if self.textures[usize::from(texture)].is_depth { 1 } else { 4 };
        let to = self.take(count);
        self.push(Op::Texel { to, texture, coordinates, count });
        Ok(to)
    }

    /// Compiles a texture query. Every texture has one level.
    pub(super) fn extent(&mut self, image: Handle<Expression>, query: &ImageQuery) -> Result<Word> {
        let texture = self.texture_of(image)?;
        match query {
            ImageQuery::NumLevels | ImageQuery::NumLayers => Ok(self.constant(1)),
            ImageQuery::Size { .. } | ImageQuery::NumSamples => {
                let to = self.take(3);
                self.push(Op::Extent { to, texture });
                Ok(if *query == ImageQuery::NumSamples { to + 2 } else { to })
            }
        }
    }

    fn texture_of(&mut self, image: Handle<Expression>) -> Result<u16> {
        match self.value(image)? {
            Value::Texture(number) => Ok(number),
            Value::Words(_) | Value::Pointer(_) => Err("a texture as a value".to_owned()),
        }
    }
}
