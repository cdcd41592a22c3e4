//! The files of a site in memory, by their paths.
//!
//! Input: paths with `/` between folders, and contents. Output: the files in the order of their paths. Equal contents that are named by
//! themselves are one file. Nothing here touches the disk.

use std::collections::BTreeMap;

/// Files by their paths.
#[derive(Default)]
pub(super) struct Files(BTreeMap<String, Vec<u8>>);

impl Files {
    /// Adds a file.
    pub(super) fn add(&mut self, path: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.0.insert(path.into(), bytes.into());
    }

    /// Adds a file whose name is computed from its content. Returns its path.
    pub(super) fn add_content(&mut self, folder: &str, extension: &str, bytes: impl Into<Vec<u8>>) -> String {
        let bytes = bytes.into();
        let path = format!("{folder}/{:016x}.{extension}", digest(&bytes));
        self.0.insert(path.clone(), bytes);
        path
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.0.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice()))
    }

    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    pub(super) fn bytes(&self) -> usize {
        self.0.values().map(Vec::len).sum()
    }
}

/// The constants of FNV-1a for 128 bits.
const OFFSET: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

/// Returns a number that other contents have only by accident: both halves of their FNV-1a, combined. It is the same on every machine.
fn digest(bytes: &[u8]) -> u64 {
    let hash = bytes.iter().fold(OFFSET, |hash, byte| (hash ^ u128::from(*byte)).wrapping_mul(PRIME));
    (hash >> 64) as u64 ^ hash as u64
}

#[cfg(test)]
mod tests {
    use super::Files;

    #[test]
    fn equal_contents_are_one_file() {
        let mut files = Files::default();
        let paths = ["a", "b", "a"].map(|text| files.add_content("scenes", "bin", text));
        assert_eq!(paths[0], paths[2]);
        assert_ne!(paths[0], paths[1]);
        assert_eq!((files.count(), files.bytes()), (2, 2));
    }
}
