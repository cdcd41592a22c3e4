//! Former words of row headers. Files that have them still parse; messages and documents use the present words.

/// The former words and the present ones.
const FORMER: [(&str, &str); 18] = [
    ("offers", "provides"),
    ("beside", "value"),
    ("critical", "mutual-exclusion"),
    ("ordered-critical", "ordered-mutual-exclusion"),
    ("own-atomics", "lock-free"),
    ("survives-races", "race-tolerant"),
    ("race", "unsynchronised"),
    ("left-to-tests", "sync-by-fixed-function"),
    ("left-to-shaders", "sync-in-shader"),
    ("best-suffice", "accepts-k-best-only"),
    ("bound-any-instant", "conservative-bound"),
    ("spares-room", "allocates-k-best-only"),
    ("loses-whole", "reports-whole-fragments"),
    ("displaces-in-turn", "displaces-under-lock"),
    ("values-pairs", "pair-values"),
    ("culls-nothing", "no-cull"),
    ("given-up", "timed-out"),
    ("unsettled", "not-converged"),
];

/// The former symbols of formulas and the present ones.
const FORMER_SYMBOLS: [(&str, &str); 1] = [("beside_words", "value_words")];

/// Returns the present word for a keyword, a capability or a property.
pub(super) fn present(word: &str) -> &str {
    FORMER.iter().find(|(former, _)| *former == word).map_or(word, |(_, present)| present)
}

/// Returns a formula with the present symbols.
pub(super) fn formula(text: &str) -> String {
    let is_other = |letter: char| !letter.is_ascii_alphanumeric() && letter != '_';
    let parts = text.split_inclusive(is_other).map(|part| {
        let word = part.trim_end_matches(is_other);
        let symbol = FORMER_SYMBOLS.iter().find(|(former, _)| *former == word).map_or(word, |(_, present)| present);
        format!("{symbol}{}", &part[word.len()..])
    });
    parts.collect()
}

#[cfg(test)]
mod tests {
    use crate::row;

    #[test]
    fn former_words_mean_the_present_ones() {
        let present = "//: storage -- all of it\n\
            //: buffer rest[pixel < pixels * (1 + value_words)]: value -- the rest\n\
            //: pass store: rest coherent\n\
            //: provides lock-free, indexed\n\
            //: requires mutual-exclusion, fragment-atomics\n\
            //: hazard timed-out -- a fragment\n\
            \n\
            fn storage_insert(pixel: u32, entry: Packed) {}\n";
        let former = present
            .replace(": value", ": beside")
            .replace("value_words", "beside_words")
            .replace("provides lock-free", "offers own-atomics")
            .replace("mutual-exclusion", "critical")
            .replace("timed-out", "given-up");
        let read = |text: &str| {
            let mut row =
                row(text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").map_err(|errors| errors.to_string())?.row;
            row.template = None;
            row.item_spans.clear();
            Ok::<_, String>(row)
        };
        let (former, present) = (read(&former), read(present));
        assert_eq!(present.as_ref().map(|row| row.hazards[0].name.to_string()), Ok("timed-out".to_owned()));
        assert_eq!(
            former.map(|row| (row.resources, row.provides, row.requires)),
            present.map(|row| (row.resources, row.provides, row.requires))
        );
    }
}
