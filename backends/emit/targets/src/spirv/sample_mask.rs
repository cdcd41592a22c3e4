//! The sample mask as Vulkan wants it. naga declares the built-in as one word; Vulkan has it as an array of words
//! (VUID-SampleMask-SampleMask-04359), of which one holds every sample there is.
//!
//! In: a module with one entry point. Out: the same, with the variable's type changed and every access led to the array's
//! first word. A module without the built-in stays as it was.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass, Word};

/// Whether an entry point has the built-in, as an input or an output, by itself or in a struct.
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

/// Mends every variable that is the sample mask, input or output; whether there was one.
pub(super) fn mend(module: &mut Module) -> Result<bool, String> {
    let variables: Vec<Word> = module.annotations.iter().filter_map(mask_variable).collect();
    let mut mended = false;
    for variable in variables {
        mended |= mend_variable(module, variable)?;
    }
    Ok(mended)
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

/// A variable that is one word so far.
struct Variable {
    /// Its place among the global values.
    place: usize,
    /// The pointer to a word, which is its type so far.
    pointer: Word,
    class: StorageClass,
    word: Word,
}

fn mend_variable(module: &mut Module, id: Word) -> Result<bool, String> {
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
    if let Some(declared) = module.types_global_values.get_mut(variable.place) {
        declared.result_type = Some(pointer);
    }
    module.types_global_values.splice(variable.place..variable.place, new);
    lead_to_first(module, id, &variable, zero)?;
    Ok(true)
}

fn one_word(module: &Module, id: Word) -> Option<Variable> {
    let place = module.types_global_values.iter().position(|declared| declared.result_id == Some(id))?;
    let pointer = module.types_global_values.get(place)?.result_type?;
    let found = |id: Word| module.types_global_values.iter().find(|declared| declared.result_id == Some(id));
    let [Operand::StorageClass(class), Operand::IdRef(word)] = *found(pointer)?.operands.as_slice() else {
        return None;
    };
    let is_word = found(word)?.class.opcode == Op::TypeInt;
    is_word.then_some(Variable { place, pointer, class, word })
}

/// Every load and store of the variable becomes one of its first word.
fn lead_to_first(module: &mut Module, id: Word, variable: &Variable, zero: Word) -> Result<(), String> {
    let mut bound = module.header.as_ref().ok_or("a module without a header")?.bound;
    for block in module.functions.iter_mut().flat_map(|function| &mut function.blocks) {
        let mut instructions = Vec::with_capacity(block.instructions.len());
        for mut instruction in std::mem::take(&mut block.instructions) {
            let touches = matches!(instruction.class.opcode, Op::Load | Op::Store)
                && instruction.operands.first() == Some(&Operand::IdRef(id));
            if touches {
                let place = vec![Operand::IdRef(id), Operand::IdRef(zero)];
                instructions.push(Instruction::new(Op::AccessChain, Some(variable.pointer), Some(bound), place));
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
        assert!(validated("as-naga-writes-it", &words).contains("04359"), "naga has been mended: this file can go");
        let mut module = load_words(&words).unwrap();
        assert!(mend(&mut module).unwrap());
        assert_eq!(validated("mended", &module.assemble()), "");
        assert!(!mend(&mut module).unwrap(), "what is mended stays as it is");
    }

    #[test]
    fn what_has_no_mask_stays_as_it_was() {
        let words = written(NEITHER);
        let mut module = load_words(&words).unwrap();
        assert!(!mend(&mut module).unwrap());
        assert_eq!(module.assemble(), load_words(&words).unwrap().assemble());
    }
}
