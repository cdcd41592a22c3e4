//! Occlusion queries: whether samples passed in a pass, or in the draw of a box.

use std::collections::BTreeMap;
use std::rc::Rc;

use ash::vk;

use crate::Error;
use crate::context::failed;
use crate::gpu::Gpu;
use crate::recorder::Recorder;

/// The queries of each pass.
pub struct Queries {
    gpu: Rc<Gpu>,
    pools: BTreeMap<String, Pool>,
}

struct Pool {
    pool: vk::QueryPool,
    capacity: u32,
    /// The queries of the latest run.
    used: u32,
}

impl Queries {
    pub fn new(gpu: &Rc<Gpu>) -> Self {
        Queries { gpu: gpu.clone(), pools: BTreeMap::new() }
    }

    /// Records that a pass begins with this number of unused queries.
    pub fn begin(&mut self, recorder: &mut Recorder, pass: &str, count: u32) -> Result<vk::QueryPool, Error> {
        if self.pools.get(pass).is_none_or(|pool| pool.capacity < count) {
            recorder.finish()?;
            let info =
                vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::OCCLUSION).query_count(count.max(1));
            // SAFETY: the device exists, and has finished what used the former pool.
            unsafe {
                let pool = self.gpu.device.create_query_pool(&info, None).map_err(failed("occlusion queries"))?;
                let created = Pool { pool, capacity: count.max(1), used: 0 };
                if let Some(former) = self.pools.insert(pass.to_owned(), created) {
                    self.gpu.device.destroy_query_pool(former.pool, None);
                }
            }
        }
        let pool = self.pools.get_mut(pass).map(|pool| {
            pool.used = count;
            (pool.pool, pool.capacity)
        });
        let (pool, capacity) = pool.unwrap_or_default();
        let commands = recorder.commands()?;
        // SAFETY: the command buffer is recording outside of a render pass.
        unsafe { self.gpu.device.cmd_reset_query_pool(commands, pool, 0, capacity) };
        Ok(pool)
    }

    /// Returns the samples of the latest run of a pass, whose commands have finished. A number above 0 may be another
    /// than that of the samples that passed.
    pub fn samples(&self, pass: &str) -> Result<Vec<u64>, Error> {
        let Some(pool) = self.pools.get(pass) else { return Ok(Vec::new()) };
        let mut samples = vec![0_u64; pool.used as usize];
        if !samples.is_empty() {
            let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
            // SAFETY: every query of the latest run has ended: `Manifest::parse` has checked that the pass draws.
            unsafe { self.gpu.device.get_query_pool_results(pool.pool, 0, &mut samples, flags) }
                .map_err(failed("the result of an occlusion query"))?;
        }
        Ok(samples)
    }
}

impl Drop for Queries {
    fn drop(&mut self) {
        for pool in self.pools.values() {
            // SAFETY: the host has waited for all commands.
            unsafe { self.gpu.device.destroy_query_pool(pool.pool, None) };
        }
    }
}
