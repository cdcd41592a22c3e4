//! Draws a scene of vertices in geometry passes, as passes in program form need it.
//!
//! Input: the plan of passes in program form, a scene. Output: draws. Materials are in `plugin`.

use fragbuf_follow::manifest::Plan;
use fragbuf_follow::{BOX, Error, Object, Scene};

use crate::follower::{Geometry, GeometryDraw};

/// The vertices of a scene on a device, and those of its objects' boxes.
pub struct Vertices {
    buffers: [wgpu::Buffer; 2],
    objects: Vec<Object>,
}

impl Vertices {
    /// Uploads a scene whose vertices lie as the inputs of the plan, one behind the other.
    pub fn new(gpu: &crate::Gpu, plan: &Plan, scene: &Scene<'_>) -> Result<Self, Error> {
        let stride = plan.vertex_inputs.iter().map(|input| 4 * input.components()).sum::<usize>();
        if stride == 0 {
            return Err(Error("the passes are in module form: they need a material".to_owned()));
        }
        let count = scene.vertices.len() / stride;
        let is_beyond = |object: &&Object| u64::from(object.first) + u64::from(object.count) > count as u64;
        if let Some(Object { first, count: wanted, .. }) = scene.objects.iter().find(is_beyond) {
            return Err(Error(format!("an object has {wanted} vertices from {first} on, and the scene has {count}")));
        }
        let upload = |bytes: &[u8]| {
            let size = (bytes.len() as u64).max(4).next_multiple_of(4);
            let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
            let descriptor = wgpu::BufferDescriptor { label: Some("vertices"), size, usage, mapped_at_creation: false };
            let buffer = gpu.device.create_buffer(&descriptor);
            gpu.queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        Ok(Vertices {
            buffers: [upload(scene.vertices), upload(&scene.boxes(stride))],
            objects: scene.objects.to_vec(),
        })
    }
}

impl Geometry for Vertices {
    fn draw(&self, draw: &GeometryDraw<'_>, mut render: wgpu::RenderPass<'static>) -> Result<(), Error> {
        let [vertices, boxes] = &self.buffers;
        let length = BOX.len() as u32;
        let is_counted = draw.call.is_queried && !draw.is_boxes && !self.objects.is_empty();
        render.set_vertex_buffer(0, if draw.is_boxes { boxes } else { vertices }.slice(..));
        if is_counted {
            render.begin_occlusion_query(0);
        }
        for (query, object) in (0..).zip(&draw.call.objects) {
            let Some(Object { first, count, .. }) = self.objects.get(*object) else { continue };
            if draw.is_boxes {
                let first = *object as u32 * length;
                render.begin_occlusion_query(query);
                render.draw(first..first + length, 0..1);
                render.end_occlusion_query();
            } else {
                render.draw(*first..*first + *count, 0..1);
            }
        }
        if is_counted {
            render.end_occlusion_query();
        }
        Ok(())
    }
}
