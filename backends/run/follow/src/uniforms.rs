//! The bytes of uniform blocks: the values of a description's uniforms, the camera, and symbols of the frame.

use std::collections::BTreeSet;

use crate::manifest::{Block, Field, Plan};
use crate::{Call, Error};

/// The bytes of the matrix in the block `camera`.
pub(crate) const CAMERA_BYTES: usize = 64;

/// The block `uniforms` of a plan; empty if it has none.
pub struct Uniforms {
    fields: Vec<Field>,
    bytes: Vec<u8>,
    /// The uniforms that have no value yet.
    unset: BTreeSet<String>,
}

impl Uniforms {
    /// Begins without values.
    pub fn new(plan: &Plan) -> Self {
        let block = plan.uniform_blocks.iter().find(|block| block.name == "uniforms");
        let fields = block.map_or(Vec::new(), |block| block.fields.clone());
        Uniforms {
            unset: fields.iter().filter_map(|field| field.uniform.clone()).collect(),
            bytes: vec![0; block.map_or(0, |block| block.bytes)],
            fields,
        }
    }

    /// Sets a uniform by its name in the description: four bytes per component.
    pub fn set(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let field = self.fields.iter().find(|field| field.uniform.as_deref() == Some(name));
        let Some(field) = field else {
            let names: Vec<String> =
                self.fields.iter().filter_map(|field| Some(format!("`{}`", field.uniform.as_ref()?))).collect();
            let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            return Err(Error(format!("the description has no uniform `{name}`: it has {known}")));
        };
        let wanted = field.bytes();
        let end = field.offset.saturating_add(bytes.len());
        match self.bytes.get_mut(field.offset..end) {
            Some(place) if bytes.len() == wanted => place.copy_from_slice(bytes),
            _ => {
                let (kind, given) = (&field.kind, bytes.len());
                return Err(Error(format!("the uniform `{name}` is a `{kind}`: set {wanted} bytes, not {given}")));
            }
        }
        self.unset.remove(name);
        Ok(())
    }

    /// Returns the bytes of the block, or an error while a uniform has no value.
    pub fn bytes(&self) -> Result<&[u8], Error> {
        match self.unset.first() {
            Some(name) => Err(Error(format!("the uniform `{name}` has no value: set it with `set_uniform`"))),
            None => Ok(&self.bytes),
        }
    }
}

impl Call<'_> {
    /// Returns the bytes of a uniform block for the pass. `view_projection` maps to the clip space of the API.
    pub fn block(&self, block: &Block, uniforms: &Uniforms, view_projection: &[f32; 16]) -> Result<Vec<u8>, Error> {
        match block.name.as_str() {
            "uniforms" => return Ok(uniforms.bytes()?.to_vec()),
            "camera" => return Ok(view_projection.iter().flat_map(|value| value.to_le_bytes()).collect()),
            _ => {}
        }
        let mut bytes = vec![0; block.bytes];
        for field in &block.fields {
            // A pass before the host step that decides a symbol does not use it.
            let value = self.value(&field.name).unwrap_or(0);
            let word = u32::try_from(value);
            let word = word.map_err(|_| Error(format!("`{}` is {value}: it exceeds 32 bits", field.name)))?;
            let place = bytes.get_mut(field.offset..field.offset.saturating_add(4));
            let place = place.ok_or_else(|| Error(format!("`{}` is outside of its uniform block", field.name)))?;
            place.copy_from_slice(&word.to_le_bytes());
        }
        Ok(bytes)
    }
}
