//! Compares the memory layouts of WGSL and of GLSL's std430 or std140.
//!
//! Both languages define every offset. They agree except for `@align`, `@size` and, in uniforms, narrow matrices. Blocks
//! print without `offset` qualifiers, so any difference is an error.

use naga::{ArraySize, Handle, Module, Type, TypeInner, VectorSize};

/// The layout rules of a block.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum LayoutRules {
    Std140,
    Std430,
}

/// Size and alignment of a type in GLSL.
struct TypeLayout {
    size: u32,
    align: u32,
}

/// Returns the first difference between the layouts of a type in WGSL and in GLSL.
pub fn layout_difference(module: &Module, ty: Handle<Type>, rules: LayoutRules) -> Option<String> {
    layout(module, ty, rules).err()
}

/// Returns the layout of a type in GLSL, or its difference from WGSL.
fn layout(module: &Module, ty: Handle<Type>, rules: LayoutRules) -> Result<TypeLayout, String> {
    match module.types[ty].inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => {
            let width = u32::from(scalar.width);
            Ok(TypeLayout { size: width, align: width })
        }
        TypeInner::Vector { size, scalar } => Ok(vector(size, u32::from(scalar.width))),
        TypeInner::Matrix { columns, rows, scalar } => matrix(columns, vector(rows, u32::from(scalar.width)), rules),
        TypeInner::Array { base, size, stride } => array(layout(module, base, rules)?, size, stride, rules),
        TypeInner::Struct { ref members, span } => structure(module, members, span, rules),
        _ => Err("a type that no buffer can hold".to_owned()),
    }
}

/// Returns the layout of a vector.
fn vector(size: VectorSize, width: u32) -> TypeLayout {
    let lanes = if size == VectorSize::Bi { 2 } else { 4 };
    TypeLayout { size: size as u32 * width, align: lanes * width }
}

/// Returns the layout of a matrix.
fn matrix(columns: VectorSize, column: TypeLayout, rules: LayoutRules) -> Result<TypeLayout, String> {
    if rules == LayoutRules::Std140 && column.align < 16 {
        return Err("a matrix of two rows, whose columns a uniform block pads to 16 bytes".to_owned());
    }
    Ok(TypeLayout { size: columns as u32 * column.align, align: column.align })
}

/// Returns the layout of an array, or its difference from WGSL.
fn array(element: TypeLayout, size: ArraySize, stride: u32, rules: LayoutRules) -> Result<TypeLayout, String> {
    let align = if rules == LayoutRules::Std140 { element.align.max(16) } else { element.align };
    let printed = element.size.next_multiple_of(align);
    if printed != stride {
        return Err(format!("an array with a stride of {stride} bytes where GLSL has {printed}"));
    }
    let count = match size {
        ArraySize::Constant(count) => count.get(),
        _ => 1,
    };
    Ok(TypeLayout { size: stride * count, align })
}

/// Returns the layout of a structure, or its difference from WGSL.
fn structure(
    module: &Module,
    members: &[naga::StructMember],
    span: u32,
    rules: LayoutRules,
) -> Result<TypeLayout, String> {
    let mut end = 0u32;
    let mut align = if rules == LayoutRules::Std140 { 16 } else { 1 };
    for member in members {
        let layout = layout(module, member.ty, rules)?;
        let offset = end.next_multiple_of(layout.align);
        if offset != member.offset {
            let name = member.name.as_deref().unwrap_or("a member");
            return Err(format!("`{name}` at byte {} where GLSL has byte {offset}", member.offset));
        }
        end = offset + layout.size;
        align = align.max(layout.align);
    }
    let size = end.next_multiple_of(align);
    // In a uniform the outermost structure may be shorter than in GLSL, because nothing follows it.
    Ok(TypeLayout { size: if rules == LayoutRules::Std140 { size } else { size.max(span) }, align })
}
