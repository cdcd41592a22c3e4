//! Values of the description's uniforms, by name.
//!
//! Input: named values. Output: the words of the uniform buffer. The model computes the offsets ([`UniformBlock`]).

use fragbuf_model::{Uniform, UniformBlock, UniformType};

use crate::Error;

/// A value for one of the description's uniforms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// `f32`
    F32(f32),
    /// `u32`
    U32(u32),
    /// `i32`
    I32(i32),
    /// `vec2`
    Vec2([f32; 2]),
    /// `vec3`
    Vec3([f32; 3]),
    /// `vec4`
    Vec4([f32; 4]),
}

impl Value {
    /// Whether every component is 0.
    pub fn is_zero(self) -> bool {
        let are_zero = |components: &[f32]| components.iter().all(|component| *component == 0.0);
        match self {
            Value::F32(value) => value == 0.0,
            Value::U32(value) => value == 0,
            Value::I32(value) => value == 0,
            Value::Vec2(value) => are_zero(&value),
            Value::Vec3(value) => are_zero(&value),
            Value::Vec4(value) => are_zero(&value),
        }
    }

    fn kind(self) -> UniformType {
        match self {
            Value::F32(_) => UniformType::F32,
            Value::U32(_) => UniformType::U32,
            Value::I32(_) => UniformType::I32,
            Value::Vec2(_) => UniformType::Vec2,
            Value::Vec3(_) => UniformType::Vec3,
            Value::Vec4(_) => UniformType::Vec4,
        }
    }

    fn words(self) -> Vec<u32> {
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect();
        match self {
            Value::F32(value) => bits(&[value]),
            Value::U32(value) => vec![value],
            Value::I32(value) => vec![value.cast_unsigned()],
            Value::Vec2(values) => bits(&values),
            Value::Vec3(values) => bits(&values),
            Value::Vec4(values) => bits(&values),
        }
    }
}

/// Returns the words of the block, all zero.
pub fn zero_uniforms(uniforms: &[Uniform]) -> Vec<u32> {
    vec![0; UniformBlock::of(uniforms).size as usize / 4]
}

/// Writes one value into the words of the block.
pub fn set_uniform(words: &mut [u32], uniforms: &[Uniform], name: &str, value: Value) -> Result<(), Error> {
    let offsets = UniformBlock::of(uniforms).offsets;
    let found = offsets.into_iter().zip(uniforms).find(|(_, uniform)| uniform.name.value == name);
    let Some((offset, uniform)) = found else {
        let names: Vec<&str> = uniforms.iter().map(|uniform| uniform.name.value.as_str()).collect();
        let expected = match names.is_empty() {
            true => "unset: the description has no uniforms".to_owned(),
            false => format!("one of the description's uniforms ({})", names.join(", ")),
        };
        return Err(Error::BadValue { name: format!("uniform `{name}`"), expected });
    };
    let kind = uniform.kind.value;
    if kind != value.kind() {
        return Err(Error::BadValue { name: format!("uniform `{name}`"), expected: kind.keyword().to_owned() });
    }
    for (word, value) in words.iter_mut().skip(offset as usize / 4).zip(value.words()) {
        *word = value;
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use fragbuf_model::{SourceSpan, Spanned};

    use super::*;

    fn uniform(name: &str, kind: UniformType) -> Uniform {
        let span = SourceSpan::new("test", 1, 1);
        Uniform { name: Spanned::new(name.to_owned(), span.clone()), kind: Spanned::new(kind, span) }
    }

    #[test]
    fn a_vector_starts_at_its_alignment() {
        let block = [uniform("a", UniformType::F32), uniform("b", UniformType::Vec3), uniform("c", UniformType::U32)];
        let mut words = zero_uniforms(&block);
        assert_eq!(words.len(), 8);
        set_uniform(&mut words, &block, "b", Value::Vec3([1.0, 2.0, 3.0])).unwrap();
        set_uniform(&mut words, &block, "c", Value::U32(7)).unwrap();
        assert_eq!(words[4..], [1.0f32.to_bits(), 2.0f32.to_bits(), 3.0f32.to_bits(), 7]);
    }

    #[test]
    fn errors_name_the_expected_type_and_the_known_uniforms() {
        let block = [uniform("a", UniformType::F32)];
        let mut words = zero_uniforms(&block);
        let wrong = set_uniform(&mut words, &block, "a", Value::U32(1)).unwrap_err();
        assert_eq!(wrong.to_string(), "uniform `a` must be f32");
        assert!(set_uniform(&mut words, &block, "b", Value::U32(1)).unwrap_err().to_string().contains("(a)"));
        let unset = set_uniform(&mut [], &[], "b", Value::U32(1)).unwrap_err();
        assert_eq!(unset.to_string(), "uniform `b` must be unset: the description has no uniforms");
    }
}
