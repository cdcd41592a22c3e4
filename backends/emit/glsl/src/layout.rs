//! Memory layout: says where GLSL's std430 or std140 would put a member that WGSL puts elsewhere.
//!
//! Both languages fix every offset, and agree except for `@align`, `@size` and, in uniforms, narrow matrices. A block is
//! printed without `offset` qualifiers, so that any disagreement is an error and never a silent shift.

use naga::{ArraySize, Handle, Module, Type, TypeInner, VectorSize};

/// Which rules the block is laid out by.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Rules {
    Std140,
    Std430,
}

struct Extent {
    size: u32,
    align: u32,
}

/// Nothing if GLSL lays the type out as WGSL does; else what differs.
pub fn disagreement(module: &Module, ty: Handle<Type>, rules: Rules) -> Option<String> {
    extent(module, ty, rules).err()
}

fn extent(module: &Module, ty: Handle<Type>, rules: Rules) -> Result<Extent, String> {
    match module.types[ty].inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => {
            let width = u32::from(scalar.width);
            Ok(Extent { size: width, align: width })
        }
        TypeInner::Vector { size, scalar } => Ok(vector(size, u32::from(scalar.width))),
        TypeInner::Matrix { columns, rows, scalar } => matrix(columns, vector(rows, u32::from(scalar.width)), rules),
        TypeInner::Array { base, size, stride } => array(extent(module, base, rules)?, size, stride, rules),
        TypeInner::Struct { ref members, span } => structure(module, members, span, rules),
        _ => Err("a type that no buffer can hold".to_owned()),
    }
}

fn vector(size: VectorSize, width: u32) -> Extent {
    let lanes = if size == VectorSize::Bi { 2 } else { 4 };
    Extent { size: size as u32 * width, align: lanes * width }
}

fn matrix(columns: VectorSize, column: Extent, rules: Rules) -> Result<Extent, String> {
    if rules == Rules::Std140 && column.align < 16 {
        return Err("a matrix of two rows, whose columns a uniform block pads to 16 bytes".to_owned());
    }
    Ok(Extent { size: columns as u32 * column.align, align: column.align })
}

fn array(element: Extent, size: ArraySize, stride: u32, rules: Rules) -> Result<Extent, String> {
    let align = if rules == Rules::Std140 { element.align.max(16) } else { element.align };
    let printed = element.size.next_multiple_of(align);
    if printed != stride {
        return Err(format!("an array with a stride of {stride} bytes where GLSL has {printed}"));
    }
    let count = match size {
        ArraySize::Constant(count) => count.get(),
        _ => 1,
    };
    Ok(Extent { size: stride * count, align })
}

fn structure(module: &Module, members: &[naga::StructMember], span: u32, rules: Rules) -> Result<Extent, String> {
    let mut end = 0u32;
    let mut align = if rules == Rules::Std140 { 16 } else { 1 };
    for member in members {
        let extent = extent(module, member.ty, rules)?;
        let offset = end.next_multiple_of(extent.align);
        if offset != member.offset {
            let name = member.name.as_deref().unwrap_or("a member");
            return Err(format!("`{name}` at byte {} where GLSL has byte {offset}", member.offset));
        }
        end = offset + extent.size;
        align = align.max(extent.align);
    }
    let size = end.next_multiple_of(align);
    // In a uniform the outermost structure may be shorter than GLSL's: nothing comes after it.
    Ok(Extent { size: if rules == Rules::Std140 { size } else { size.max(span) }, align })
}
