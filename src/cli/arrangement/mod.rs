//! `--presort`, `--batch` and `--subdivide`: the order and the shape of the triangles of a scene before they are drawn (B06 §3.2, §4.3).
//!
//! Input: a scene view. Output: the same surfaces in another order or in more triangles, and the disorder of its fragments before and after. A
//! technique whose image does not depend on the order of fragments renders the same image, except for rounding along the edges of divided
//! triangles.

mod disorder;

use std::num::NonZeroU32;

use fragbuf_scene::DepthOrder;

pub(crate) use disorder::Disorder;

use super::memory::Budget;
use super::output::{self, Failure};
use super::view::SceneView;

/// The arrangement of triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, clap::Args)]
pub(crate) struct Arrangement {
    /// Draw triangles by the depth of their centroids, from front to back, or from back to front with `farthest`. The disorder of fragments
    /// before and after is printed
    #[arg(
        long,
        value_name = "nearest|farthest",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "nearest",
        value_parser = depth_order
    )]
    presort: Option<DepthOrder>,
    /// Draw sorted triangles in batches of so many, each in a draw of its own. The CPU device draws all in one
    #[arg(long, value_name = "TRIANGLES", requires = "presort", value_parser = batch)]
    batch: Option<NonZeroU32>,
    /// Divide long and thin triangles until there are so many times as many triangles, from 1 to 1000
    #[arg(long, value_name = "RATIO", value_parser = ratio)]
    subdivide: Option<f64>,
}

impl Arrangement {
    /// Returns the arrangement of an experiment: sorted from front to back after a subdivision.
    #[cfg(feature = "figures")]
    pub(crate) fn sorted(subdivide: f64) -> Self {
        Arrangement { presort: Some(DepthOrder::NearestFirst), batch: None, subdivide: Some(subdivide) }
    }

    /// Arranges the triangles of a scene that is lit already, so that its colours stay linear over the divided triangles. Measures the
    /// disorder if the fragments fit into memory.
    pub(crate) fn apply(&self, view: &mut SceneView, size: (u32, u32), memory: Budget) -> Result<(), Failure> {
        if self.presort.is_none() && self.subdivide.is_none() {
            return Ok(());
        }
        let order = self.presort.unwrap_or(DepthOrder::NearestFirst);
        let probe = disorder::Probe::new(size, order)?;
        let before = probe.measure(view, memory)?;
        if let Some(ratio) = self.subdivide {
            // The larger scene counts where it is used.
            memory.without(view.scene.subdivision_bytes(ratio), "the subdivision")?;
            view.scene.subdivide(ratio);
        }
        if self.presort.is_some() {
            view.scene.presort(&view.camera, order);
        }
        let after = probe.measure(view, memory)?;
        view.batch = self.batch;
        view.disorder = before.zip(after).map(|(before, after)| Disorder { before, after });
        Ok(())
    }
}

/// Prints the disorder of fragments before and after, if it is known.
pub(crate) fn print(view: &SceneView) {
    if let Some(Disorder { before, after }) = view.disorder {
        output::note(&format!(
            "disorder: {before} in the order of the model, {after} as arranged; it is the greatest number of places between where a fragment of a pixel arrives and where its depth belongs"
        ));
    }
}

fn depth_order(text: &str) -> Result<DepthOrder, String> {
    match text {
        "nearest" => Ok(DepthOrder::NearestFirst),
        "farthest" => Ok(DepthOrder::FarthestFirst),
        _ => Err("write `--presort` or `--presort=nearest` for front to back, or `--presort=farthest`".to_owned()),
    }
}

fn batch(text: &str) -> Result<NonZeroU32, String> {
    text.trim().parse().map_err(|_| format!("write a whole number of triangles from 1 to {}, such as 32", u32::MAX))
}

/// The greatest ratio of triangles after a subdivision.
const MAX_RATIO: f64 = 1000.0;

fn ratio(text: &str) -> Result<f64, String> {
    let ratio = text.trim().parse().ok().filter(|ratio| (1.0..=MAX_RATIO).contains(ratio));
    ratio.ok_or_else(|| {
        format!("write the number of triangles afterwards over that before, from 1 to {MAX_RATIO}, such as 1.5")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_ranges() {
        assert_eq!((ratio("1"), ratio("1.5"), ratio("1e3")), (Ok(1.0), Ok(1.5), Ok(1000.0)));
        for text in ["0.99", "0", "-2", "1001", "nan", "inf", "", "2x", "150%"] {
            assert!(ratio(text).is_err_and(|help| help.contains("such as 1.5")), "{text}");
        }
        assert_eq!(batch("32").map(NonZeroU32::get), Ok(32));
        for text in ["0", "-1", "1.5", "", "4294967296"] {
            assert!(batch(text).is_err_and(|help| help.contains("such as 32")), "{text}");
        }
        assert_eq!(depth_order("farthest"), Ok(DepthOrder::FarthestFirst));
        assert!(depth_order("front").is_err_and(|help| help.contains("--presort=farthest")));
    }
}
