//! A macro for enumerations whose variants have a name and a meaning.

/// Declares an enumeration from its documentation, its name, and one variant with its meaning per line.
macro_rules! names {
    ($(#[$about:meta])* $name:ident { $($variant:ident $meaning:literal;)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name { $(#[doc = $meaning] $variant,)* }

        impl $name {
            /// All variants.
            pub const ALL: &[$name] = &[$($name::$variant),*];

            /// Returns the name in manifests and row headers: the variant in kebab case.
            pub fn name(self) -> String {
                let mut name = String::new();
                for letter in format!("{self:?}").chars() {
                    if letter.is_ascii_uppercase() && !name.is_empty() {
                        name.push('-');
                    }
                    name.push(letter.to_ascii_lowercase());
                }
                name
            }

            /// Returns the meaning, as the object of "requires".
            pub fn meaning(self) -> &'static str {
                match self { $($name::$variant => $meaning,)* }
            }
        }
    };
}

pub(super) use names;
