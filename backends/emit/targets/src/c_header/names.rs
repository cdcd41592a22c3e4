//! Writes names, strings and comments in C. Names are legal in C++ too, and none is reserved in either.

use std::collections::BTreeSet;

/// Words that no name may be: keywords of C and C++, alternative operators, and macros of headers that programs include before.
const TAKEN: &str = "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t char8_t class compl \
    concept const const_cast consteval constexpr constinit continue co_await co_return co_yield decltype default delete do double \
    dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable namespace new noexcept not \
    not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires restrict return short signed sizeof \
    static static_assert static_cast struct switch template this thread_local throw true try typedef typeid typename typeof \
    typeof_unqual union unsigned using virtual void volatile wchar_t while xor xor_eq \
    assert errno far i386 interface linux max min near offsetof small unix BOOL EOF FALSE I NULL TRUE";

/// Returns a name. A word that is taken has an underscore at its end.
pub(super) fn identifier(name: &str) -> String {
    let mut identifier = legal(name);
    let is_number_macro = |word: &str| word.starts_with("INT") || word.starts_with("UINT");
    if TAKEN.split_whitespace().any(|word| word == identifier) || is_number_macro(&identifier) {
        identifier.push('_');
    }
    identifier
}

/// Returns the beginning of a name: `u` and the code point in hexadecimal stand for a character that C does not have in names, `_0_` for two
/// underscores, and `x` begins a name that begins with an underscore or a digit.
pub(super) fn legal(name: &str) -> String {
    let mut legal = String::with_capacity(name.len());
    for letter in name.chars() {
        match letter {
            '_' | '-' | '.' | ' ' => legal.push_str(if legal.ends_with('_') { "0_" } else { "_" }),
            letter if letter.is_ascii_alphanumeric() => legal.push(letter),
            letter => legal.push_str(&format!("u{:04x}", u32::from(letter))),
        }
    }
    if legal.starts_with('_') {
        legal.insert(0, 'x');
    } else if !legal.starts_with(|first: char| first.is_ascii_alphabetic()) {
        legal.insert_str(0, "x_");
    }
    legal
}

/// The names of one scope. C accepts each name once, but names of a description may become equal, for example by their case.
#[derive(Default)]
pub(super) struct Names(BTreeSet<String>);

impl Names {
    /// Returns the name, with a number appended if it is taken.
    pub(super) fn fresh(&mut self, name: &str) -> String {
        let plain = identifier(name);
        let numbered = (2..).map(|number| format!("{plain}_{number}").replace("__", "_"));
        let fresh = std::iter::once(plain.clone()).chain(numbered).find(|name| !self.0.contains(name));
        let fresh = fresh.unwrap_or(plain);
        self.0.insert(fresh.clone());
        fresh
    }
}

/// Returns a string literal. `?` is escaped because two of them begin a trigraph.
pub(super) fn string(text: &str) -> String {
    let mut literal = String::from("\"");
    for byte in text.bytes() {
        match byte {
            b'"' | b'\\' | b'?' => {
                literal.push('\\');
                literal.push(byte.into());
            }
            b' '..=b'~' => literal.push(byte.into()),
            byte => literal.push_str(&format!("\\{byte:03o}")),
        }
    }
    literal.push('"');
    literal
}

/// Returns text for the inside of a comment: one line that does not end the comment or begin another, or change the direction of text.
pub(super) fn comment(text: &str) -> String {
    let is_direction =
        |letter: char| matches!(u32::from(letter), 0x061c | 0x200e | 0x200f | 0x202a..=0x202e | 0x2066..=0x2069);
    let plain = |letter: char| if letter.is_control() || is_direction(letter) { ' ' } else { letter };
    let text: String = text.chars().map(plain).collect();
    // First the backslash, because it becomes a part of the others.
    text.replace('\\', "/").replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_legal_in_c_and_cpp() {
        let names = [
            "tint",
            "größe",
            "a__b",
            "_x",
            "2d",
            "class",
            "restrict",
            "near",
            "my-glass.v2",
            "",
            "_",
            "INT32_MAX",
            "a___",
        ];
        let expected = [
            "tint",
            "gru00f6u00dfe",
            "a_0_b",
            "x_x",
            "x_2d",
            "class_",
            "restrict_",
            "near_",
            "my_glass_v2",
            "x_",
            "x_",
            "INT32_MAX_",
            "a_0_0_",
        ];
        assert_eq!(names.map(identifier), expected);
    }

    #[test]
    fn equal_names_get_numbers() {
        let mut names = Names::default();
        assert_eq!(
            ["a", "a", "a", "class", "class_"].map(|name| names.fresh(name)),
            ["a", "a_2", "a_3", "class_", "class_2"]
        );
    }

    #[test]
    fn strings_and_comments_cannot_end_early() {
        assert_eq!(string("a\"b\\c??/\n§"), r#""a\"b\\c\?\?/\012\302\247""#);
        assert_eq!(comment("a *\\ b \\* c"), "a * / b / * c");
        assert_eq!(comment("a */ b /* c ??/\n\u{202e}§\\"), "a * / b / * c ? ?/  §/");
    }
}
