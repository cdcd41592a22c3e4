//! Mutants of WGSL source: a statement deleted, two consecutive ones swapped, an atomic operation split into a read and a
//! write, a number incremented or decremented, `<` ↔ `<=`, and the atomic access of a published word made that of a guarded one.

/// One mutant.
pub(crate) struct Mutant {
    /// The function of the line; empty outside of functions.
    pub(crate) function: String,
    pub(crate) text: String,
    /// The line before and after the mutation.
    pub(crate) before: String,
    pub(crate) after: String,
}

/// Returns every mutant, in the order of lines.
pub(crate) fn mutants(text: &str) -> Vec<Mutant> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (at, line) in lines.iter().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
        let mut change = |new: Vec<String>, extra: &str| {
            let after = new.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
            let preceding = lines[..at].iter().map(|line| (*line).to_owned());
            let following = lines[at + 1..].iter().map(|line| (*line).to_owned());
            let all: Vec<String> = preceding.chain(new).chain(following).collect();
            let (text, function) = (format!("{}\n{extra}", all.join("\n")), function_of(&lines[..=at]));
            found.push(Mutant { function, text, before: line.trim().to_owned(), after });
        };
        if is_statement(line) {
            change(Vec::new(), "");
        }
        for new in numbers(line).into_iter().chain(comparisons(line)).chain(unpublished(line)) {
            change(vec![new], "");
        }
        if let Some((new, function)) = plain(line) {
            change(vec![new], &function);
        }
        if let Some(next) = lines.get(at + 1).filter(|next| is_swappable(line) && is_swappable(next)) {
            let mut swapped: Vec<&str> = lines.clone();
            swapped.swap(at, at + 1);
            let text = format!("{}\n", swapped.join("\n"));
            let after = format!("{} {}", next.trim(), line.trim());
            let before = format!("{} {}", line.trim(), next.trim());
            found.push(Mutant { function: function_of(&lines[..=at]), text, before, after });
        }
    }
    found
}

/// Returns the name of the function that the last of these lines is in.
fn function_of(lines: &[&str]) -> String {
    let begin = lines.iter().rev().take_while(|line| **line != "}").find_map(|line| line.strip_prefix("fn "));
    begin.map_or(String::new(), |rest| rest.split('(').next().unwrap_or_default().to_owned())
}

fn is_statement(line: &str) -> bool {
    line.starts_with("    ") && line.trim_end().ends_with(';')
}

fn is_swappable(line: &str) -> bool {
    let text = line.trim_start();
    is_statement(line) && !["let ", "var ", "return"].iter().any(|word| text.starts_with(word))
}

/// Returns the line with each number incremented and decremented.
fn numbers(line: &str) -> Vec<String> {
    let mut found = Vec::new();
    let bytes = line.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        let starts =
            bytes[at].is_ascii_digit() && (at == 0 || !bytes[at - 1].is_ascii_alphanumeric() && bytes[at - 1] != b'_');
        let length = bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        if starts && bytes.get(at + length) == Some(&b'u') {
            let number: u32 = line[at..at + length].parse().unwrap();
            for other in [number.wrapping_add(1), number.wrapping_sub(1)] {
                found.push(format!("{}{other}{}", &line[..at], &line[at + length..]));
            }
        }
        at += length.max(1);
    }
    found
}

/// Returns the line with each comparison made strict or not strict.
fn comparisons(line: &str) -> Vec<String> {
    let pairs = [(" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > ")];
    let matches = pairs.iter().flat_map(|(old, new)| line.match_indices(old).map(move |(at, _)| (at, old, new)));
    matches.map(|(at, old, new)| format!("{}{new}{}", &line[..at], &line[at + old.len()..])).collect()
}

/// Returns the line with the accessors of words that are read outside of the critical section replaced by those of other words.
fn unpublished(line: &str) -> Option<String> {
    let new = line.replace("_publish(", "_store(").replace("_hint(", "_load(");
    (new != line && !line.starts_with("fn ")).then_some(new)
}

/// Returns the line with `x_atomic_op(…)` replaced by a call of a function that reads and writes separately, and the function.
fn plain(line: &str) -> Option<(String, String)> {
    let at = line.find("_atomic_")?;
    let start =
        line[..at].rfind(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').map_or(0, |at| at + 1);
    let resource = &line[start..at];
    let rest = &line[at + "_atomic_".len()..];
    let (operation, arguments) = rest.split_once('(')?;
    let arguments = &arguments[..matching(arguments)?];
    let values = if operation == "compare_exchange" { 2 } else { 1 };
    let indices: Vec<String> = (values..arguments.split(',').count()).map(|number| format!("i{number}")).collect();
    let parameters: Vec<String> = indices.iter().map(|index| format!("{index}: u32, ")).collect();
    let index = indices.join(", ");
    let comma = if indices.is_empty() { "" } else { ", " };
    if operation == "compare_exchange" {
        let function = format!(
            "fn plainly({}expected: u32, value: u32) -> bool {{\n    let old = {resource}_load({index});\n    if old == expected {{\n        {resource}_store({index}{comma}value);\n    }}\n    return old == expected;\n}}\n",
            parameters.concat()
        );
        return Some((line.replacen(&format!("{resource}_atomic_{operation}"), "plainly", 1), function));
    }
    let new = match operation {
        "add" => "old + value",
        "sub" => "old - value",
        "exchange" => "value",
        "min" => "min(old, value)",
        "max" => "max(old, value)",
        "or" => "old | value",
        other => panic!("no plain form of {other}"),
    };
    let function = format!(
        "fn plainly({}value: u32) -> u32 {{\n    let old = {resource}_load({index});\n    {resource}_store({index}{comma}{new});\n    return old;\n}}\n",
        parameters.concat()
    );
    Some((line.replacen(&format!("{resource}_atomic_{operation}"), "plainly", 1), function))
}

/// Returns the length of the arguments up to their closing bracket.
fn matching(text: &str) -> Option<usize> {
    let mut depth = 0;
    text.char_indices().find_map(|(at, letter)| match letter {
        '(' => {
            depth += 1;
            None
        }
        ')' if depth == 0 => Some(at),
        ')' => {
            depth -= 1;
            None
        }
        _ => None,
    })
}
