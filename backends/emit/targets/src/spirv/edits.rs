//! Edits naga's SPIR-V to add what naga cannot write: the built-in for helper invocations, the begin and end of an interlock,
//! the sample mask as an array, and plain accesses of words that other functions access atomically.
//!
//! The input is a module with one entry point in which markers are named functions. The output has each call of a marker
//! replaced, and the required declarations. A module without such calls is returned unchanged.

use rspirv::binary::Assemble;
use rspirv::dr::{Function, Instruction, Module, Operand, load_words};
use rspirv::spirv::{BuiltIn, Capability, Decoration, ExecutionMode, Op, StorageClass, Word};

use super::sample_mask;
use crate::emission::InterlockOrder;
use crate::markers::{CRITICAL_BEGIN, CRITICAL_END, HELPER_LANE};

/// Tests whether the words of an entry point may need an edit: its module has a marker or a guarded accessor, or it uses the sample
/// mask.
pub(super) fn may_apply(module: &naga::Module, entry: &str, prefix: &str, guarded: &[String]) -> bool {
    let markers = [CRITICAL_BEGIN, CRITICAL_END, HELPER_LANE].map(|marker| format!("{prefix}{marker}"));
    let is_marker = |name: &String| markers.contains(name) || guarded.contains(name);
    let Some(point) = module.entry_points.iter().find(|point| point.name == entry) else { return true };
    point.stage == naga::ShaderStage::Fragment
        && (module.functions.iter().any(|(_, function)| function.name.as_ref().is_some_and(is_marker))
            || sample_mask::is_in(module, &point.function))
}

/// Applies the edits. `prefix` precedes the markers' names; accesses of the functions `guarded` become plain.
pub(super) fn apply(
    words: Vec<u32>,
    prefix: &str,
    order: InterlockOrder,
    guarded: &[String],
) -> Result<Vec<u32>, String> {
    let mut module = load_words(&words).map_err(|error| format!("rspirv cannot parse naga's SPIR-V: {error}"))?;
    let begin = replace(&mut module, &format!("{prefix}{CRITICAL_BEGIN}"), |_| {
        Some(Instruction::new(Op::BeginInvocationInterlockEXT, None, None, vec![]))
    });
    let end = replace(&mut module, &format!("{prefix}{CRITICAL_END}"), |_| {
        Some(Instruction::new(Op::EndInvocationInterlockEXT, None, None, vec![]))
    });
    if begin || end {
        declare_interlock(&mut module, order)?;
    }
    let helper = read_helper_invocation(&mut module, &format!("{prefix}{HELPER_LANE}"))?;
    let mask = sample_mask::correct(&mut module)?;
    let plain = make_plain(&mut module, guarded);
    Ok(if begin || end || helper || mask || plain { module.assemble() } else { words })
}

/// Replaces every call of the function `name`. Returns whether there was one.
fn replace(module: &mut Module, name: &str, with: impl Fn(&Instruction) -> Option<Instruction>) -> bool {
    let Some(function) = named(module, name) else { return false };
    let mut found = false;
    for instruction in module.all_inst_iter_mut().filter(|instruction| calls(instruction, function)) {
        if let Some(other) = with(instruction) {
            *instruction = other;
            found = true;
        }
    }
    found
}

/// Turns the atomic loads and stores of functions into plain ones. Returns whether there was one.
fn make_plain(module: &mut Module, functions: &[String]) -> bool {
    let ids: Vec<Word> = functions.iter().filter_map(|name| named(module, name)).collect();
    let is_one = |function: &&mut Function| {
        function.def.as_ref().and_then(|definition| definition.result_id).is_some_and(|id| ids.contains(&id))
    };
    let mut found = false;
    for function in module.functions.iter_mut().filter(is_one) {
        for instruction in function.blocks.iter_mut().flat_map(|block| &mut block.instructions) {
            // The operands of both are the pointer, the scope and the semantics; then, of a store, the value.
            let plain = match instruction.class.opcode {
                Op::AtomicLoad => Op::Load,
                Op::AtomicStore => Op::Store,
                _ => continue,
            };
            let operands = instruction.operands.iter().enumerate().filter(|(index, _)| *index != 1 && *index != 2);
            let operands = operands.map(|(_, operand)| operand.clone()).collect();
            *instruction = Instruction::new(plain, instruction.result_type, instruction.result_id, operands);
            found = true;
        }
    }
    found
}

fn named(module: &Module, name: &str) -> Option<Word> {
    module.debug_names.iter().find_map(|instruction| match instruction.operands.as_slice() {
        [Operand::IdRef(id), Operand::LiteralString(text)] if text == name => Some(*id),
        _ => None,
    })
}

fn calls(instruction: &Instruction, function: Word) -> bool {
    instruction.class.opcode == Op::FunctionCall && instruction.operands.first() == Some(&Operand::IdRef(function))
}

fn declare_interlock(module: &mut Module, order: InterlockOrder) -> Result<(), String> {
    let entry = entry_point(module)?;
    let capability = Operand::Capability(Capability::FragmentShaderPixelInterlockEXT);
    module.capabilities.push(Instruction::new(Op::Capability, None, None, vec![capability]));
    let extension = Operand::LiteralString("SPV_EXT_fragment_shader_interlock".to_owned());
    module.extensions.push(Instruction::new(Op::Extension, None, None, vec![extension]));
    let mode = Operand::ExecutionMode(match order {
        InterlockOrder::Any => ExecutionMode::PixelInterlockUnorderedEXT,
        InterlockOrder::Submission => ExecutionMode::PixelInterlockOrderedEXT,
    });
    module.execution_modes.push(Instruction::new(Op::ExecutionMode, None, None, vec![Operand::IdRef(entry), mode]));
    Ok(())
}

fn entry_point(module: &Module) -> Result<Word, String> {
    match module.entry_points.first().map(|entry| entry.operands.as_slice()) {
        Some([_, Operand::IdRef(id), ..]) => Ok(*id),
        _ => Err("a module without an entry point".to_owned()),
    }
}

/// Replaces every call by a load of the built-in input variable. Returns whether there was one.
fn read_helper_invocation(module: &mut Module, name: &str) -> Result<bool, String> {
    let Some(function) = named(module, name) else { return Ok(false) };
    let call = module.all_inst_iter().find(|instruction| calls(instruction, function));
    let Some(boolean) = call.and_then(|call| call.result_type) else { return Ok(false) };
    let header = module.header.as_mut().ok_or("a module without a header")?;
    let (pointer, variable) = (header.bound, header.bound + 1);
    header.bound += 2;
    let input = Operand::StorageClass(StorageClass::Input);
    module.types_global_values.push(Instruction::new(
        Op::TypePointer,
        None,
        Some(pointer),
        vec![input.clone(), Operand::IdRef(boolean)],
    ));
    module.types_global_values.push(Instruction::new(Op::Variable, Some(pointer), Some(variable), vec![input]));
    let built_in = [Operand::Decoration(Decoration::BuiltIn), Operand::BuiltIn(BuiltIn::HelperInvocation)];
    module.annotations.push(Instruction::new(
        Op::Decorate,
        None,
        None,
        std::iter::once(Operand::IdRef(variable)).chain(built_in).collect(),
    ));
    for entry in &mut module.entry_points {
        entry.operands.push(Operand::IdRef(variable));
    }
    Ok(replace(module, name, |call| {
        Some(Instruction::new(Op::Load, Some(boolean), call.result_id, vec![Operand::IdRef(variable)]))
    }))
}
