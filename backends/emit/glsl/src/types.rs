//! Prints naga types as GLSL type names and declarations.
//!
//! Naming a structure here also requires its declaration, which `globals` prints later.

use naga::proc::TypeResolution;
use naga::{ArraySize, Handle, Module, PredeclaredType, Scalar, ScalarKind, Span, Type, TypeInner, VectorSize};

use crate::helpers::{Helper, lanes};
use crate::printer::Printer;

/// Returns `uint`, `int`, `float`, `bool` or `uint64_t`; nothing for other widths.
pub fn scalar_name(scalar: Scalar) -> Option<&'static str> {
    match (scalar.kind, scalar.width) {
        (ScalarKind::Uint, 4) => Some("uint"),
        (ScalarKind::Uint, 8) => Some("uint64_t"),
        (ScalarKind::Sint, 4) => Some("int"),
        (ScalarKind::Float, 4) => Some("float"),
        (ScalarKind::Bool, _) => Some("bool"),
        _ => None,
    }
}

/// Returns the name that messages use for a scalar without a GLSL name.
pub fn unsupported_scalar(scalar: Scalar) -> String {
    let letter = match scalar.kind {
        ScalarKind::Uint => 'u',
        ScalarKind::Sint => 'i',
        ScalarKind::Float => 'f',
        ScalarKind::Bool => return "bool".to_owned(),
        ScalarKind::AbstractInt => return "an abstract integer".to_owned(),
        ScalarKind::AbstractFloat => return "an abstract float".to_owned(),
    };
    format!("{letter}{} values", u32::from(scalar.width) * 8)
}

/// Returns `vec`, `ivec`, `uvec` or `bvec`.
pub fn vector_stem(scalar: Scalar) -> &'static str {
    match scalar.kind {
        ScalarKind::Uint => "uvec",
        ScalarKind::Sint => "ivec",
        ScalarKind::Bool => "bvec",
        _ => "vec",
    }
}

/// Returns the name of a vector, such as `vec4`; without a size, the scalar's name. Vectors of 64-bit components have none.
pub fn numeric_name(size: Option<VectorSize>, scalar: Scalar) -> Option<String> {
    let name = scalar_name(scalar)?;
    Some(match size {
        Some(_) if scalar.width > 4 => return None,
        Some(size) => format!("{}{}", vector_stem(scalar), size as u8),
        None => name.to_owned(),
    })
}

/// Returns size and scalar of a numeric or atomic type.
pub fn numeric(inner: &TypeInner) -> Option<(Option<VectorSize>, Scalar)> {
    match *inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Some((None, scalar)),
        TypeInner::Vector { size, scalar } => Some((Some(size), scalar)),
        _ => None,
    }
}

impl Printer<'_> {
    /// Returns the name of a type as a constructor: `uint`, `vec4`, `Packed`, `float[8]`.
    pub fn type_name(&mut self, ty: Handle<Type>, span: Span) -> String {
        let (base, dimensions) = self.split_type(ty, span);
        base + &dimensions
    }

    /// As [`Self::type_name`], for the type of an expression.
    pub fn resolved_name(&mut self, resolution: &TypeResolution, span: Span) -> String {
        match resolution {
            TypeResolution::Handle(handle) => self.type_name(*handle, span),
            TypeResolution::Value(inner) => self.inner_name(inner, span),
        }
    }

    /// Returns a declaration without qualifiers or value: `uint keys[8]`.
    pub fn declaration(&mut self, ty: Handle<Type>, name: &str, span: Span) -> String {
        let (base, dimensions) = self.split_type(ty, span);
        format!("{base} {name}{dimensions}")
    }

    /// As [`Self::declaration`], for the type of an expression.
    pub fn resolved_declaration(&mut self, resolution: &TypeResolution, name: &str, span: Span) -> String {
        match resolution {
            TypeResolution::Handle(handle) => self.declaration(*handle, name, span),
            TypeResolution::Value(inner) => format!("{} {name}", self.inner_name(inner, span)),
        }
    }

    /// Returns the element type and the array dimensions, outermost first.
    fn split_type(&mut self, ty: Handle<Type>, span: Span) -> (String, String) {
        let inner = self.module.types[ty].inner.clone();
        match inner {
            TypeInner::Array { base, size, .. } => {
                let (name, dimensions) = self.split_type(base, span);
                let size = match size {
                    ArraySize::Constant(size) => size.to_string(),
                    ArraySize::Dynamic => String::new(),
                    ArraySize::Pending(_) => self.error("an array sized by an override", span),
                };
                (name, format!("[{size}]{dimensions}"))
            }
            TypeInner::Struct { .. } => {
                if let Some(helper) = result_of(self.module, ty) {
                    self.helper(helper);
                    return (helper.result().unwrap_or_default(), String::new());
                }
                self.requirements.types.insert(ty);
                let name = self.names.types.get(&ty).cloned();
                (name.unwrap_or_else(|| self.error("a structure without a name", span)), String::new())
            }
            inner => (self.inner_name(&inner, span), String::new()),
        }
    }

    /// Returns the name of a type that is no array and no structure.
    fn inner_name(&mut self, inner: &TypeInner, span: Span) -> String {
        if let Some((size, scalar)) = numeric(inner) {
            self.require_width(scalar);
            let name = numeric_name(size, scalar);
            return name.unwrap_or_else(|| self.error(unsupported_scalar(scalar), span));
        }
        match *inner {
            TypeInner::Matrix { columns, rows, scalar } if scalar == Scalar::F32 => {
                if columns == rows {
                    format!("mat{}", columns as u8)
                } else {
                    format!("mat{}x{}", columns as u8, rows as u8)
                }
            }
            TypeInner::Pointer { base, .. } => self.type_name(base, span),
            TypeInner::ValuePointer { size, scalar, .. } => {
                let name = numeric_name(size, scalar);
                name.unwrap_or_else(|| self.error(unsupported_scalar(scalar), span))
            }
            TypeInner::Matrix { scalar, .. } => self.error(format!("matrices of {}", unsupported_scalar(scalar)), span),
            _ => self.error(format!("a value of type {inner:?}"), span),
        }
    }

    /// Requires the extension of a scalar type, if it has one.
    pub fn require_width(&mut self, scalar: Scalar) {
        if scalar == Scalar::U64 && self.es() {
            self.error("64-bit integers", Span::UNDEFINED);
        } else if scalar == Scalar::U64 {
            let vulkan = "GL_EXT_shader_explicit_arithmetic_types_int64";
            self.requirements.extensions.insert(if self.vulkan() { vulkan } else { "GL_ARB_gpu_shader_int64" });
        }
    }

    /// Returns the zero value of a type.
    pub fn zero(&mut self, ty: Handle<Type>, span: Span) -> String {
        let inner = self.module.types[ty].inner.clone();
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => zero_scalar(scalar).to_owned(),
            TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => {
                format!("{}({})", self.type_name(ty, span), zero_scalar(scalar))
            }
            TypeInner::Array { base, size: ArraySize::Constant(size), .. } => {
                let element = self.zero(base, span);
                let elements = vec![element; size.get() as usize].join(", ");
                format!("{}({elements})", self.type_name(ty, span))
            }
            TypeInner::Struct { members, .. } => {
                let zeros: Vec<String> = members.iter().map(|member| self.zero(member.ty, span)).collect();
                format!("{}({})", self.type_name(ty, span), zeros.join(", "))
            }
            _ => self.error("the zero value of this type", span),
        }
    }
}

/// Returns the helper that defines a type, if it is the result of modf() or frexp().
fn result_of(module: &Module, ty: Handle<Type>) -> Option<Helper> {
    let (predeclared, _) = module.special_types.predeclared_types.iter().find(|(_, handle)| **handle == ty)?;
    match *predeclared {
        PredeclaredType::ModfResult { size, .. } => Some(Helper::Modf(lanes(size))),
        PredeclaredType::FrexpResult { size, .. } => Some(Helper::Frexp(lanes(size))),
        _ => None,
    }
}

fn zero_scalar(scalar: Scalar) -> &'static str {
    match scalar.kind {
        ScalarKind::Uint if scalar.width == 8 => "0ul",
        ScalarKind::Uint => "0u",
        ScalarKind::Sint => "0",
        ScalarKind::Bool => "false",
        _ => "0.0",
    }
}
