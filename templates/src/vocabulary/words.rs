//! Enumerations whose variants have a word and a meaning each. In: variants and meanings. Out: the type, its table, its words.

/// Declares one: the type's documentation and name, then a variant and its meaning a line.
macro_rules! words {
    ($(#[$about:meta])* $name:ident { $($variant:ident $meaning:literal;)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name { $(#[doc = $meaning] $variant,)* }

        impl $name {
            /// All of them.
            pub const ALL: &[$name] = &[$($name::$variant),*];

            /// The word of manifests and of rows in files: the name in lower case, joined by `-`.
            pub fn word(self) -> String {
                let mut word = String::new();
                for letter in format!("{self:?}").chars() {
                    if letter.is_ascii_uppercase() && !word.is_empty() {
                        word.push('-');
                    }
                    word.push(letter.to_ascii_lowercase());
                }
                word
            }

            /// What it means, as the object of "requires".
            pub fn meaning(self) -> &'static str {
                match self { $($name::$variant => $meaning,)* }
            }
        }
    };
}

pub(super) use words;
