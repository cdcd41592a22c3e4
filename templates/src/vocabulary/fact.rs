//! What rows offer each other. Legality is `requires ⊆ offers`, over the chosen rows, the payload and the target.

macro_rules! facts {
    ($($variant:ident $meaning:literal;)*) => {
        /// One thing that a row, a payload or a target can offer, and another require.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Fact { $(#[doc = $meaning] $variant,)* }

        impl Fact {
            /// Every fact.
            pub const ALL: &[Fact] = &[$(Fact::$variant),*];

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

            /// What the fact means, as the object of "requires".
            pub fn meaning(self) -> &'static str {
                match self { $(Fact::$variant => $meaning,)* }
            }
        }
    };
}

facts! {
    // Between a storage and a sync.
    Critical "that writers of one pixel take turns";
    OrderedCritical "that writers of one pixel take turns in the order of submission";
    OwnAtomics "a storage that keeps writers apart by its own atomic operations";
    SurvivesRaces "a storage whose behaviour stays defined when writers race";
    FixedFunction "a storage that leaves writers to depth test, stencil or blending";
    // What a storage can be asked.
    KeepsAll "a storage that keeps every fragment";
    KeepsBest "a storage that keeps the k best";
    SelectsBest "that the k best are chosen among all";
    BoundAnyInstant "a bound that no fragment of the final k best ever fails, at any instant";
    CanReplace "that a kept fragment can be replaced";
    Counted "the number of fragments of each pixel, known before they are stored";
    Indexed "kept fragments with an index";
    Passes "a build step for every kept fragment";
    // What the kept fragments are, once gathered.
    Sorted "fragments in the order of depth";
    // What a description offers.
    Limited "a limit on what is kept: `keep 8`";
    DepthKey "that depth decides which fragment is worst: no criterion";
    Color "an attribute `color` of format rgba8, rgba16 or vec4";
    OneWordBesideDepth "at most one word beside depth in the payload";
    OneWordBesideKey "at most one word beside the key: the payload is depth and one word, or with a criterion depth alone";
    // What a target offers.
    FragmentAtomics "atomic operations in fragment shaders";
    Fences "memory fences in fragment shaders";
    Coherent "coherent plain words in buffers";
    Interlock "fragment shader interlock";
    U64Atomics "64-bit atomic operations that return a value";
    EarlyDepth "a forced early depth test";
    MinMaxBlend "blending by minimum and maximum";
    SampleMask "a fixed sample mask and several samples per pixel";
    Linkable "functions that a caller's own shader can call";
    OwnEntryPoints "entry points of its own: `--form program`";
}
