//! The memory budget of a command: `--memory`, and what is left of it.
//!
//! Everything that grows with the scene or with the image is taken from it: files and scenes, vertices, images, and what a device
//! allocates for a frame.

use super::output::Failure;

/// The units of `--memory`, and their bytes as powers of 2. The last is the default unit.
const UNITS: [(&str, u32); 5] = [("tib", 40), ("gib", 30), ("mib", 20), ("kib", 10), ("b", 0)];

/// Memory that is left of the budget of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Budget {
    whole: u64,
    left: u64,
}

impl Budget {
    /// Returns the bytes that are left.
    pub(crate) fn left(self) -> u64 {
        self.left
    }

    /// Returns the bytes of the whole budget.
    pub(crate) fn whole(self) -> u64 {
        self.whole
    }

    /// Returns the budget of each of several parts that are in memory at the same time.
    #[cfg(feature = "figures")]
    pub(crate) fn divided(self, parts: u64) -> Self {
        let parts = parts.max(1);
        Budget { whole: self.whole / parts, left: self.left / parts }
    }

    /// Returns what is left beside `bytes` bytes.
    pub(crate) fn without(self, bytes: u64, what: &str) -> Result<Self, Failure> {
        let Budget { whole, left } = self;
        let rest = left.checked_sub(bytes).ok_or_else(|| {
            Failure::Device(format!(
                "out of the memory budget: {bytes} bytes are needed for {what}, and {left} of {whole} bytes are left: use a smaller image \
                 or scene, or raise `--memory`"
            ))
        })?;
        Ok(Budget { whole, left: rest })
    }
}

/// Parses a size: `2GiB`, `512MiB`, or a number of bytes.
pub(crate) fn budget(text: &str) -> Result<Budget, String> {
    let lower = text.trim().to_ascii_lowercase();
    let unit = UNITS.iter().find_map(|(unit, power)| Some((lower.strip_suffix(unit)?, *power)));
    let (number, power) = unit.unwrap_or((&lower, 0));
    let bytes = number.trim().parse::<u64>().ok().and_then(|number| number.checked_mul(1 << power));
    let bytes = bytes.filter(|bytes| *bytes > 0);
    let whole = bytes.ok_or("write a whole number above 0 of bytes, KiB, MiB, GiB or TiB, such as 512MiB")?;
    Ok(Budget { whole, left: whole })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        let bytes = |text: &str| budget(text).map(Budget::left).ok();
        assert_eq!(bytes("2GiB"), Some(2_147_483_648));
        assert_eq!(bytes("512 mib"), Some(536_870_912));
        assert_eq!((bytes("3KiB"), bytes("7B"), bytes("7")), (Some(3072), Some(7), Some(7)));
        assert_eq!(bytes("16777215TiB"), Some(16_777_215 << 40));
        for text in ["16777216TiB", "18446744073709551616", "0", "-1", "1.5GiB", "GiB", "", "2GB", "2 G"] {
            assert_eq!(bytes(text), None, "{text}");
        }
    }

    #[test]
    fn a_part_beyond_the_rest_is_an_error() {
        let rest = budget("100").and_then(|whole| whole.without(40, "a").map_err(|_| String::new()));
        assert_eq!(rest, Ok(Budget { whole: 100, left: 60 }));
        let failure = rest.map(|rest| rest.without(61, "the image"));
        let Ok(Err(Failure::Device(text))) = failure else { unreachable!("the budget has 60 bytes") };
        assert!(text.contains("61 bytes are needed for the image, and 60 of 100 bytes are left"), "{text}");
    }
}
