//! Records a pass: its uniform blocks, the barriers before it, its dispatch or its draws.

use std::collections::BTreeMap;

use ash::vk;
use fragbuf_follow::manifest::{BindingKind, Kind, Objects, Pass};
use fragbuf_follow::{BOX, Call};

use crate::Error;
use crate::access::Access;
use crate::bindings::sampled;
use crate::engine::Frame;
use crate::memory::{Memory, Texture};

impl Frame<'_, '_> {
    /// Records a pass.
    pub fn record(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        for name in pass.uses.keys() {
            self.engine.memory_of(call.resource(name), call.values)?;
        }
        let (objects, pipeline, render_pass) = self.engine.pipeline(pass, call)?;
        let layout = objects.shaders.layout;
        let name_of = |name: &str| call.resource(name).to_owned();
        let bindings: Vec<(String, BindingKind)> =
            objects.shaders.bindings.iter().map(|binding| (name_of(&binding.name), binding.kind)).collect();
        let attached: Vec<(String, Access)> =
            objects.attachments.names().map(|name| (name_of(name), objects.attachments.access(name))).collect();
        for (name, _) in bindings.iter().filter(|(_, kind)| *kind == BindingKind::Uniform) {
            self.write_block(name, call)?;
        }
        let bound: Vec<String> = bindings.into_iter().map(|(name, _)| name).collect();
        let indirect = pass.uses.iter().find(|(_, access)| *access == "indirect").map(|(name, _)| name_of(name));
        self.wait(pass, call, &attached)?;
        let query = self.begin_queries(pass, call)?;
        let sets = self.sets(call.step, bound)?;
        let point = match pass.kind {
            Kind::Compute => vk::PipelineBindPoint::COMPUTE,
            Kind::Fullscreen | Kind::Geometry => vk::PipelineBindPoint::GRAPHICS,
        };
        let indirect = match indirect.map(|name| &self.engine.memory[&name]) {
            Some(Memory::Buffer(buffer)) => Some(buffer.buffer),
            _ => None,
        };
        let commands = self.engine.recorder.commands()?;
        let device = &self.engine.gpu.device;
        // SAFETY: the command buffer is recording, and the pipeline, its layout and its sets belong together.
        unsafe {
            device.cmd_bind_pipeline(commands, point, pipeline);
            if !sets.is_empty() {
                device.cmd_bind_descriptor_sets(commands, point, layout, 0, &sets, &[]);
            }
        }
        if pass.kind != Kind::Compute {
            return self.draw(pass, call, (render_pass, &attached), (query, indirect));
        }
        if let Some(arguments) = indirect {
            // SAFETY: the arguments are the first three words of the buffer.
            unsafe { device.cmd_dispatch_indirect(commands, arguments, 0) };
            return Ok(());
        }
        let [x, y, z] = call.groups(pass, self.engine.gpu.limits.max_compute_work_group_count)?;
        // SAFETY: the numbers are within the limits.
        unsafe { device.cmd_dispatch(commands, x, y, z) };
        Ok(())
    }

    /// Records that a uniform block gets the values of this pass.
    fn write_block(&mut self, name: &str, call: &Call<'_>) -> Result<(), Error> {
        let plan = self.engine.plan.clone();
        let block = plan.uniform_blocks.iter().find(|block| block.name == name);
        let block = block.ok_or_else(|| Error(format!("there is no uniform block `{name}`")))?;
        let bytes = call.block(block, self.uniforms, &self.scene.view_projection)?;
        let engine = &mut *self.engine;
        engine.blocks.write(&engine.gpu, &mut engine.recorder, name, &bytes)
    }

    /// Records the barriers before everything that the pass uses.
    fn wait(&mut self, pass: &Pass, call: &Call<'_>, attached: &[(String, Access)]) -> Result<(), Error> {
        let mut uses: BTreeMap<String, Access> = attached.iter().cloned().collect();
        for (name, access) in &pass.uses {
            let name = call.resource(name);
            let memory = self.engine.memory_of(name, call.values)?;
            if let Some(next) = access_of(access, pass.kind, memory)? {
                uses.entry(name.to_owned()).and_modify(|known| *known = known.and(next)).or_insert(next);
            }
        }
        let engine = &mut *self.engine;
        let mut changes = Vec::with_capacity(uses.len());
        for (name, next) in &uses {
            let change = match engine.memory_of(name, call.values)? {
                Memory::Buffer(buffer) => buffer.state.change(*next, false),
                Memory::Texture(texture) => texture.state.change(*next, true),
            };
            changes.extend(change.map(|change| (change, name)));
        }
        let texture = |name: &String| match &engine.memory[name] {
            Memory::Texture(texture) => Some(texture),
            Memory::Buffer(_) => None,
        };
        let barriers: Vec<_> = changes.into_iter().map(|(change, name)| (change, texture(name))).collect();
        engine.recorder.barriers(&barriers)
    }

    /// Returns the descriptor sets of a pass whose bindings mean these resources.
    fn sets(&mut self, step: usize, names: Vec<String>) -> Result<Vec<vk::DescriptorSet>, Error> {
        let engine = &mut *self.engine;
        let Some(objects) = engine.passes.get(&step) else { return Ok(Vec::new()) };
        engine.cache.sets(step, &objects.shaders, names, (&engine.memory, &engine.blocks))
    }

    /// Records that the queries of a pass begin, if its samples are counted: one per box, or one for the pass.
    fn begin_queries(&mut self, pass: &Pass, call: &Call<'_>) -> Result<Option<vk::QueryPool>, Error> {
        let count = match pass.objects {
            Objects::Boxes => call.objects.len() as u32,
            _ if call.is_queried => 1,
            _ => return Ok(None),
        };
        let engine = &mut *self.engine;
        engine.queries.begin(&mut engine.recorder, &pass.name, count).map(Some)
    }

    /// Records the draws of a pass.
    fn draw(
        &mut self,
        pass: &Pass,
        call: &Call<'_>,
        (render_pass, attached): (vk::RenderPass, &[(String, Access)]),
        (query, indirect): (Option<vk::QueryPool>, Option<vk::Buffer>),
    ) -> Result<(), Error> {
        let engine = &mut *self.engine;
        let view = |(name, _): &(String, Access)| match &engine.memory[name] {
            Memory::Texture(texture) => Some(whole_view(texture)),
            Memory::Buffer(_) => None,
        };
        let views: Vec<vk::ImageView> = attached.iter().filter_map(view).collect();
        let framebuffer = engine.cache.framebuffer(render_pass, views, engine.size)?;
        let [width, height] = engine.size;
        let area = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        let begin =
            vk::RenderPassBeginInfo::default().render_pass(render_pass).framebuffer(framebuffer).render_area(area);
        // y points up in clip space, and the first row is the upper one.
        let viewport = vk::Viewport {
            x: 0.0,
            y: height as f32,
            width: width as f32,
            height: -(height as f32),
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let mut rectangle = [0; 4];
        for (value, formula) in rectangle.iter_mut().zip(&engine.plan.scissor) {
            *value = call.value(formula)?.min(i32::MAX as u64) as u32;
        }
        let [x, y, columns, rows] = rectangle;
        let scissor = vk::Rect2D {
            offset: vk::Offset2D { x: x as i32, y: y as i32 },
            extent: vk::Extent2D { width: columns, height: rows },
        };
        let reference = match &pass.state.stencil {
            Some(stencil) => Some(call.value(&stencil.reference)? as u32),
            None => None,
        };
        let commands = engine.recorder.commands()?;
        let device = &engine.gpu.device;
        let is_boxes = matches!(pass.objects, Objects::Boxes);
        let per_pass = query.filter(|_| !is_boxes);
        // SAFETY: the command buffer is recording, the pipeline is bound, and `render` of the host has checked that
        // the scene has the vertices of its objects.
        unsafe {
            device.cmd_begin_render_pass(commands, &begin, vk::SubpassContents::INLINE);
            device.cmd_set_viewport(commands, 0, &[viewport]);
            device.cmd_set_scissor(commands, 0, &[scissor]);
            if let Some(reference) = reference {
                device.cmd_set_stencil_reference(commands, vk::StencilFaceFlags::FRONT_AND_BACK, reference);
            }
            if let Some(pool) = per_pass {
                device.cmd_begin_query(commands, pool, 0, vk::QueryControlFlags::empty());
            }
            if let (Kind::Geometry, Some(vertices)) = (pass.kind, &engine.vertices[usize::from(is_boxes)]) {
                device.cmd_bind_vertex_buffers(commands, 0, &[vertices.buffer], &[0]);
            }
            match (pass.kind, indirect, query.filter(|_| is_boxes)) {
                (Kind::Geometry, _, Some(pool)) => {
                    for (query, object) in (0..).zip(&call.objects) {
                        device.cmd_begin_query(commands, pool, query, vk::QueryControlFlags::empty());
                        device.cmd_draw(commands, BOX.len() as u32, 1, (BOX.len() * object) as u32, 0);
                        device.cmd_end_query(commands, pool, query);
                    }
                }
                (Kind::Geometry, ..) => {
                    for [first, count] in ranges(self.scene.objects, &call.objects) {
                        device.cmd_draw(commands, count, 1, first, 0);
                    }
                }
                (_, Some(arguments), _) => device.cmd_draw_indirect(commands, arguments, 0, 1, 0),
                _ => device.cmd_draw(commands, 3, 1, 0, 0),
            }
            if let Some(pool) = per_pass {
                device.cmd_end_query(commands, pool, 0);
            }
            device.cmd_end_render_pass(commands);
        }
        Ok(())
    }
}

/// Returns the vertices of objects in their order, first and count. Objects that follow each other in memory are one
/// range.
fn ranges(objects: &[fragbuf_follow::Object], drawn: &[usize]) -> Vec<[u32; 2]> {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for object in drawn.iter().filter_map(|index| objects.get(*index)).filter(|object| object.count > 0) {
        match ranges.last_mut() {
            Some([first, count]) if *first + *count == object.first => *count += object.count,
            _ => ranges.push([object.first, object.count]),
        }
    }
    ranges
}

fn whole_view(texture: &Texture) -> vk::ImageView {
    texture.view(crate::names::aspects(texture.format))
}

/// Returns the access that a word of `uses` means. `None`: an attachment, whose access depends on the state of the
/// pass.
fn access_of(name: &str, kind: Kind, memory: &Memory) -> Result<Option<Access>, Error> {
    let stage = match kind {
        Kind::Compute => vk::PipelineStageFlags::COMPUTE_SHADER,
        Kind::Fullscreen | Kind::Geometry => vk::PipelineStageFlags::FRAGMENT_SHADER,
    };
    let buffer = |stages, access| Some(Access::new(stages, access, vk::ImageLayout::UNDEFINED));
    let written = vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE;
    Ok(match (name, memory) {
        ("attachment", Memory::Texture(_)) => None,
        ("sampled", Memory::Texture(texture)) => Some(sampled(texture.format)),
        ("read", Memory::Buffer(_)) => buffer(stage, vk::AccessFlags::SHADER_READ),
        ("plain" | "atomic" | "coherent", Memory::Buffer(_)) => buffer(stage, written),
        ("indirect", Memory::Buffer(_)) => {
            buffer(vk::PipelineStageFlags::DRAW_INDIRECT, vk::AccessFlags::INDIRECT_COMMAND_READ)
        }
        _ => return Err(Error(format!("a resource is used as `{name}`, which its kind does not allow"))),
    })
}

#[cfg(test)]
mod tests {
    use fragbuf_follow::Object;

    use super::ranges;

    #[test]
    fn objects_that_follow_each_other_are_one_draw() {
        let object = |first, count| Object { first, count, bounds: [[0.0; 3]; 2] };
        let objects = [object(0, 6), object(6, 3), object(12, 3), object(9, 3), object(3, 0)];
        assert_eq!(ranges(&objects, &[0, 1, 3, 2, 4]), [[0, 15]]);
        assert_eq!(ranges(&objects, &[0, 2, 3]), [[0, 6], [12, 3], [9, 3]]);
    }
}
