//! The disorder of the fragments of a view: how far the order in which they arrive is from the order of their depths.
//!
//! Input: a scene view. Output: the greatest disorder of a pixel (k-NSS; B06 §3, Table 2). The CPU device draws an A-buffer of the depths in
//! submission order, and the words of the buffer are read: the region of a pixel fills from its end.

use std::sync::Arc;

use fragbuf::Registry;
use fragbuf_cpu::{Code, Device, Error, FragmentOrder, Mesh, Settings};
use fragbuf_frame::Error as FrameError;
use fragbuf_scene::{DepthOrder, disorder};
use serde_json::{Value, json};

use crate::cli::attributes::geometry;
use crate::cli::input::Input;
use crate::cli::memory::Budget;
use crate::cli::output::{self, Failure};
use crate::cli::view::SceneView;

/// The disorder of a scene as modelled, and as arranged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Disorder {
    pub(crate) before: u32,
    pub(crate) after: u32,
}

impl Disorder {
    /// Returns the field of statistics.
    pub(crate) fn json(self) -> Value {
        json!({ "before": self.before, "after": self.after })
    }
}

/// Measures the disorder of scenes at a size of the image.
pub(super) struct Probe {
    code: Arc<Code>,
    size: (u32, u32),
    order: DepthOrder,
}

impl Probe {
    pub(super) fn new(size: (u32, u32), order: DepthOrder) -> Result<Self, Failure> {
        let registry = Registry::builtin();
        let mut input = Input::text("depths", include_str!("depths.fragbuf"));
        let code = Code::of(&input.variant(&[], &registry)?, &registry)?;
        Ok(Probe { code: Arc::new(code), size, order })
    }

    /// Returns the greatest disorder of a pixel. `None`, with a warning: the fragments do not fit into memory.
    pub(super) fn measure(&self, view: &SceneView, memory: Budget) -> Result<Option<u32>, Failure> {
        match self.depths(view, memory)? {
            Some(pixels) => Ok(Some(pixels.map(|depths| disorder(&depths, self.order)).max().unwrap_or(0))),
            None => {
                output::warn(
                    "the disorder of fragments is not measured, because they are out of the memory budget: raise `--memory`, or use a smaller image",
                );
                Ok(None)
            }
        }
    }

    /// Returns the depths of the fragments of each pixel, in the order of their arrival. `None`: they do not fit into memory.
    fn depths(&self, view: &SceneView, memory: Budget) -> Result<Option<impl Iterator<Item = Vec<f32>>>, Failure> {
        let memory = memory.without(view.scene.bytes(), "the scene")?;
        let geometry = geometry((&view.scene, &[]), &self.code.plan, memory)?;
        let (width, height) = self.size;
        // In one slice: the words of a slice replace those of the one before.
        let settings = Settings {
            order: FragmentOrder::Submission,
            memory: geometry.memory.left(),
            slice: Some(height),
            ..Settings::new(width, height)
        };
        let drawn = Device::new(self.code.clone(), settings).and_then(|mut device| {
            device.set_camera(&view.camera.view_projection);
            device.render(&Mesh { vertices: &geometry.vertices, indices: &geometry.indices }, &|_| {})?;
            Ok(device)
        });
        let device = match drawn {
            Err(error) if is_too_large(&error) => return Ok(None),
            drawn => drawn?,
        };
        let words = |name: &str| {
            device
                .words(name)
                .ok_or_else(|| Failure::Device(format!("the description of depths has no buffer `{name}`")))
        };
        let (offsets, entries) = (words("offsets")?, words("entries")?);
        let regions: Vec<(usize, usize)> =
            offsets.windows(2).filter_map(|pair| Some((*pair.first()? as usize, *pair.last()? as usize))).collect();
        Ok(Some(regions.into_iter().map(move |(begin, end)| {
            let region = entries.get(begin..end).unwrap_or_default();
            region.iter().rev().map(|key| f32::from_bits(*key)).collect()
        })))
    }
}

fn is_too_large(error: &Error) -> bool {
    let is_size = |error: &FrameError| matches!(error, FrameError::TooLarge { .. } | FrameError::OverBudget(_));
    matches!(error, Error::OutOfMemory { .. }) || matches!(error, Error::Frame(error) if is_size(error))
}

#[cfg(test)]
mod tests {
    use fragbuf_scene::{Camera, Object, Scene};

    use super::*;
    use crate::cli::memory::budget;

    /// Returns a view of quads over the whole frame at these depths, drawn in this order.
    fn quads(depths: &[f32]) -> SceneView {
        let quad = |depth: &f32| {
            let positions: Vec<[f32; 3]> =
                [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x, y, *depth]).to_vec();
            Object {
                normals: vec![[0.0, 0.0, 1.0]; 4],
                colors: vec![[1.0; 4]; 4],
                triangles: vec![[0, 1, 2], [0, 2, 3]],
                positions,
                ..Object::default()
            }
        };
        let scene = Scene { objects: depths.iter().map(quad).collect(), ..Scene::default() };
        SceneView::new(scene, Camera::clip())
    }

    /// The depths of every pixel are those of the quads, in their order.
    #[test]
    fn depths_arrive_in_the_order_of_submission() -> Result<(), String> {
        let memory = budget("64MiB")?;
        for depths in [vec![0.5], vec![0.5, 0.25, 0.75, 0.25], (0..40).map(|at| 0.02 * (at * 7 % 40) as f32).collect()]
        {
            let probe = Probe::new((5, 3), DepthOrder::NearestFirst).map_err(|_| "no code")?;
            let view = quads(&depths);
            let found = probe.depths(&view, memory).map_err(|_| "no depths")?.ok_or("too large")?;
            let found: Vec<Vec<f32>> = found.collect();
            assert_eq!(found, vec![depths.clone(); 15]);
            let expected = disorder(&depths, DepthOrder::NearestFirst);
            assert_eq!(probe.measure(&view, memory).map_err(|_| "no disorder")?, Some(expected));
        }
        Ok(())
    }

    #[test]
    fn fragments_beyond_the_memory_are_not_measured() -> Result<(), String> {
        let probe = Probe::new((64, 64), DepthOrder::NearestFirst).map_err(|_| "no code")?;
        let measured = probe.measure(&quads(&[0.5; 200]), budget("1MiB")?).map_err(|_| "failed")?;
        assert_eq!(measured, None);
        Ok(())
    }
}
