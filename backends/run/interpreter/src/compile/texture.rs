//! Textures: texels by column, row, and sample or level; extents.
//!
//! In: flat textures that are read. Out: instructions. Whatever filters, has layers or is written is refused by name.

use naga::{Expression, GlobalVariable, Handle, ImageClass, ImageDimension, ImageQuery, ScalarKind, TypeInner};

use super::{Compiler, Result, Value};
use crate::operation::{Op, Word};
use crate::program::Texture;

impl Compiler<'_> {
    /// A variable that is a texture.
    pub(super) fn texture(&mut self, variable: &GlobalVariable) -> Result<Value> {
        let TypeInner::Image { dim, arrayed, class } = self.shapes.inner(variable.ty) else {
            return Err("samplers".to_owned());
        };
        if *dim != ImageDimension::D2 || *arrayed {
            return Err("a texture that is not flat".to_owned());
        }
        let (kind, is_depth, is_multisampled) = match class {
            ImageClass::Sampled { kind, multi } => (*kind, false, *multi),
            ImageClass::Depth { multi } => (ScalarKind::Float, true, *multi),
            ImageClass::Storage { .. } | ImageClass::External => return Err("storage and external textures".to_owned()),
        };
        let number = u16::try_from(self.textures.len()).map_err(|_| "so many textures".to_owned())?;
        let name = variable.name.clone().unwrap_or_default();
        let binding = variable.binding.map(|binding| (binding.group, binding.binding));
        self.textures.push(Texture { name, binding, kind, is_depth, is_multisampled });
        Ok(Value::Texture(number))
    }

    /// `textureLoad`.
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
        let place = self.take(3);
        self.push(Op::Copy { to: place, from: coordinate, count: 2 });
        self.push(Op::Copy { to: place + 2, from: number, count: 1 });
        let count = if self.textures[usize::from(texture)].is_depth { 1 } else { 4 };
        let to = self.take(count);
        self.push(Op::Texel { to, texture, place, count });
        Ok(to)
    }

    /// `textureDimensions` and its kin. There is one level.
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
            Value::Words(_) | Value::Spot(_) => Err("a texture that is a value".to_owned()),
        }
    }
}
