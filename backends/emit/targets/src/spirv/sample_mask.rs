//! Corrects the type of the sample mask. naga declares the built-in as one word; Vulkan requires an array of words
//! (VUID-SampleMask-SampleMask-04359), of which one word holds every sample.
//!
//! The input is a module with one entry point. In the output the variable has the array type and every access goes to its first
//! word. A module without the built-in is unchanged.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass, Word};

/// Tests whether an entry point has the built-in as an input or an output, by itself or in a struct.
pub(super) fn is_in(module: &naga::Module, function: &naga::Function) -> bool {
    let is_mask = |binding: Option<&naga::Binding>| binding == Some(&naga::Binding::BuiltIn(naga::BuiltIn::SampleMask));
    let holds = |kind: naga::Handle<naga::Type>| match &module.types[kind].inner {
        naga::TypeInner::Struct { members, .. } => members.iter().any(|member| is_mask(member.binding.as_ref())),
        _ => false,
    };
    let arguments = function.arguments.iter().map(|argument| (argument.binding.as_ref(), argument.ty));
    let results = function.result.iter().map(|result| (result.binding.as_ref(), result.ty));
    arguments.chain(results).any(|(binding, kind)| is_mask(binding) || holds(kind))
}

/// Corrects every sample mask variable. Returns whether there was one.
pub(super) fn correct(module: &mut Module) -> Result<bool, String> {
    let variables: Vec<Word> = module.annotations.iter().filter_map(mask_variable).collect();
    let mut corrected = false;
    for variable in variables {
        corrected |= correct_variable(module, variable)?;
    }
    Ok(corrected)
}

fn mask_variable(annotation: &Instruction) -> Option<Word> {
    let is_mask = annotation.class.opcode == Op::Decorate
        && annotation.operands.get(1..)
            == Some(&[Operand::Decoration(Decoration::BuiltIn), Operand::BuiltIn(BuiltIn::SampleMask)]);
    match annotation.operands.first() {
        Some(Operand::IdRef(variable)) if is_mask => Some(*variable),
        _ => None,
    }
}

/// A variable whose type is one word.
struct Variable {
    /// Its index among the global values.
    index: usize,
    /// The type of the variable: pointer to a word.
    pointer: Word,
    class: StorageClass,
    word: Word,
}

fn correct_variable(module: &mut Module, id: Word) -> Result<bool, String> {
    let Some(variable) = one_word(module, id) else { return Ok(false) };
    let header = module.header.as_mut().ok_or("a module without a header")?;
    let [zero, one, array, pointer] = std::array::from_fn(|index| header.bound + index as u32);
    header.bound += 4;
    let word = Some(variable.word);
    let class = Operand::StorageClass(variable.class);
    let new = [
        Instruction::new(Op::Constant, word, Some(zero), vec![Operand::LiteralBit32(0)]),
        Instruction::new(Op::Constant, word, Some(one), vec![Operand::LiteralBit32(1)]),
        Instruction::new(Op::TypeArray, None, Some(array), vec![Operand::IdRef(variable.word), Operand::IdRef(one)]),
        Instruction::new(Op::TypePointer, None, Some(pointer), vec![class, Operand::IdRef(array)]),
    ];
    if let Some(declared) = module.types_global_values.get_mut(variable.index) {
        declared.result_type = Some(pointer);
    }
    module.types_global_values.splice(variable.index..variable.index, new);
    redirect_to_first(module, id, &variable, zero)?;
    Ok(true)
}

fn one_word(module: &Module, id: Word) -> Option<Variable> {
    let index = module.types_global_values.iter().position(|declared| declared.result_id == Some(id))?;
    let pointer = module.types_global_values.get(index)?.result_type?;
    let found = |id: Word| module.types_global_values.iter().find(|declared| declared.result_id == Some(id));
    let [Operand::StorageClass(class), Operand::IdRef(word)] = *found(pointer)?.operands.as_slice() else {
        return None;
    };
    let is_word = found(word)?.class.opcode == Op::TypeInt;
    is_word.then_some(Variable { index, pointer, class, word })
}

/// Redirects every load and store of the variable to its first word.
fn redirect_to_first(module: &mut Module, id: Word, variable: &Variable, zero: Word) -> Result<(), String> {
    let mut bound = module.header.as_ref().ok_or("a module without a header")?.bound;
    for block in module.functions.iter_mut().flat_map(|function| &mut function.blocks) {
        let mut instructions = Vec::with_capacity(block.instructions.len());
        for mut instruction in std::mem::take(&mut block.instructions) {
            let touches = matches!(instruction.class.opcode, Op::Load | Op::Store)
                && instruction.operands.first() == Some(&Operand::IdRef(id));
            if touches {
                let operands = vec![Operand::IdRef(id), Operand::IdRef(zero)];
                instructions.push(Instruction::new(Op::AccessChain, Some(variable.pointer), Some(bound), operands));
                if let Some(operand) = instruction.operands.first_mut() {
                    *operand = Operand::IdRef(bound);
                }
                bound += 1;
            }
            instructions.push(instruction);
        }
        block.instructions = instructions;
    }
    if let Some(header) = module.header.as_mut() {
        header.bound = bound;
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
mod tests {
    use std::process::Command;

    use naga::back::spv;
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    use rspirv::binary::Assemble;
    use rspirv::dr::load_words;

    use super::*;

    const BOTH_WAYS: &str = "
        struct Output { @location(0) color: vec4<f32>, @builtin(sample_mask) mask: u32 }
        @fragment
        fn main(@builtin(sample_mask) covered: u32, @builtin(sample_index) sample: u32) -> Output {
            return Output(vec4<f32>(f32(covered)), covered & (1u << sample));
        }";

    const NEITHER: &str = "@fragment fn main() -> @location(0) vec4<f32> { return vec4<f32>(1.0); }";

    fn written(text: &str) -> Vec<u32> {
        let module = naga::front::wgsl::parse_str(text).unwrap();
        let capabilities = Capabilities::MULTISAMPLED_SHADING;
        let info = Validator::new(ValidationFlags::all(), capabilities).validate(&module).unwrap();
        let options = spv::Options { lang_version: (1, 3), ..spv::Options::default() };
        spv::write_vec(&module, &info, &options, None).unwrap()
    }

    fn validated(name: &str, words: &[u32]) -> String {
        let path = std::env::temp_dir().join(format!("fragbuf-{name}-{}.spv", std::process::id()));
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        std::fs::write(&path, bytes).unwrap();
        let output = Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(&path).output();
        let output = output.unwrap_or_else(|error| panic!("spirv-val must be installed (see README): {error}"));
        std::fs::remove_file(&path).unwrap();
        String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
    }

    #[test]
    fn input_and_output_become_arrays() {
        let words = written(BOTH_WAYS);
        assert!(validated("as-naga-writes-it", &words).contains("04359"), "naga has been fixed: remove this file");
        let mut module = load_words(&words).unwrap();
        assert!(correct(&mut module).unwrap());
        assert_eq!(validated("corrected", &module.assemble()), "");
        assert!(!correct(&mut module).unwrap(), "a corrected module is unchanged");
    }

    #[test]
    fn a_module_without_a_mask_is_unchanged() {
        let words = written(NEITHER);
        let mut module = load_words(&words).unwrap();
        assert!(!correct(&mut module).unwrap());
        assert_eq!(module.assemble(), load_words(&words).unwrap().assemble());
    }
}
