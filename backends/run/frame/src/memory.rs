//! The memory of a frame: the bytes of every resource, and the rows of a slice that fit.
//!
//! Input: a plan, the values of its symbols and the limits of a device. Output: bytes and rows, or an error with the numbers.
//! Every device asks here before it allocates; this module allocates nothing.

use fragbuf_codegen::{Action, PassId, Plan, ResourceId, SymbolId};

use crate::{Error, MemoryNeed, Values};

/// The default budget of a device: 2 GiB.
pub const DEFAULT_MEMORY: u64 = 2 << 30;

/// The limits of a device, and the memory that it allocates for a frame beside the plan's resources.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryLimits {
    /// The bytes that the device may allocate for a frame. Where a host step resizes a buffer, a device may keep the former one until
    /// the commands that use it have run; the former one is not counted.
    pub budget: u64,
    /// The greatest size of a buffer.
    pub buffer: BufferLimit,
    /// Whether the device has its own copy of external textures.
    pub copies_external: bool,
    /// The bytes per pixel of the frame: its image.
    pub per_pixel: u64,
    /// The bytes per pixel of a slice.
    pub per_slice_pixel: u64,
    /// The bytes per slice.
    pub per_slice: u64,
}

/// The greatest size of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BufferLimit {
    /// The size in bytes.
    pub bytes: u64,
    /// The name of the limit, and its unit.
    pub name: &'static str,
    /// The suggested fix where a buffer exceeds it.
    pub help: &'static str,
}

impl MemoryLimits {
    /// Returns the rows of a slice: those that the caller requests, or the most that fit. `Err`: one row does not fit.
    pub fn rows(&self, plan: &Plan, values: &Values, requested: Option<u32>) -> Result<u32, Error> {
        if plan.needs_whole_frame() {
            return self.whole_frame(plan, values, requested);
        }
        if let Some(rows) = requested {
            return Ok(rows.clamp(1, values.height().max(1)));
        }
        // Lower slices have smaller buffers, but there are more of them. The memory of all slices is that of a former attempt,
        // until it is enough.
        let mut all_slices = 0;
        loop {
            let attempt = |rows: u32| self.check(plan, &values.with_rows(rows), all_slices);
            // If one row does not fit, the error has its numbers.
            attempt(1)?;
            let rows = most_rows(values.height(), |rows| attempt(rows).is_ok()).max(1);
            let needed = self.all_slices(&values.with_rows(rows));
            if needed <= all_slices {
                return Ok(rows);
            }
            all_slices = needed;
        }
    }

    /// Returns all rows, for a plan whose passes read other pixels. `Err`: the caller requests fewer, or the frame does not fit.
    fn whole_frame(&self, plan: &Plan, values: &Values, requested: Option<u32>) -> Result<u32, Error> {
        let height = values.height();
        if requested.is_some_and(|rows| rows < height) {
            return Err(Error::BadValue {
                name: "the rows of a slice".to_owned(),
                expected: format!(
                    "{height}, those of the frame: closures read images of the description at other pixels"
                ),
            });
        }
        self.check(plan, values, self.per_slice)?;
        Ok(height)
    }

    /// Returns the bytes of every resource, for slices of the rows of `values`. `Err`: a buffer exceeds its limit, or all together
    /// exceed the budget.
    pub fn sizes(&self, plan: &Plan, values: &Values) -> Result<Vec<u64>, Error> {
        self.check(plan, values, self.all_slices(values))
    }

    /// Returns the bytes of the budget that are left beside slices of the rows of `values`.
    pub fn left(&self, plan: &Plan, values: &Values) -> Result<u64, Error> {
        let (need, _) = self.need(plan, values, self.all_slices(values))?;
        Ok(self.budget.saturating_sub(need.total()))
    }

    fn all_slices(&self, values: &Values) -> u64 {
        self.per_slice.saturating_mul(values.slices().into())
    }

    fn check(&self, plan: &Plan, values: &Values, all_slices: u64) -> Result<Vec<u64>, Error> {
        let (need, sizes) = self.need(plan, values, all_slices)?;
        if need.total() <= need.budget { Ok(sizes) } else { Err(Error::OverBudget(need)) }
    }

    /// Returns what slices of the rows of `values` need, and the bytes of every resource. `Err`: a buffer exceeds its limit.
    fn need(&self, plan: &Plan, values: &Values, all_slices: u64) -> Result<(MemoryNeed, Vec<u64>), Error> {
        let size = (values.width(), values.height());
        let image = self.per_pixel.saturating_mul(u64::from(size.0) * u64::from(size.1));
        let slices = self.per_slice_pixel.saturating_mul(values.pixels()).saturating_add(all_slices);
        let budget = self.budget;
        let mut need = MemoryNeed { size, rows: values.rows(), image, textures: 0, buffers: slices, budget };
        let mut sizes = resource_bytes(plan, values)?.into_iter().map(|(_, bytes)| bytes).collect::<Vec<_>>();
        for (bytes, planned) in sizes.iter_mut().zip(&plan.resources) {
            if !planned.is_texture() {
                self.check_buffer(&planned.resource.name, *bytes)?;
                need.buffers = need.buffers.saturating_add(*bytes);
                continue;
            }
            if planned.is_external() && !self.copies_external {
                *bytes = 0;
            }
            need.textures = need.textures.saturating_add(*bytes);
        }
        Ok((need, sizes))
    }

    fn check_buffer(&self, name: &str, needed: u64) -> Result<(), Error> {
        let BufferLimit { bytes: limit, name: limit_name, help } = self.buffer;
        if needed <= limit {
            return Ok(());
        }
        Err(Error::TooLarge { what: format!("`{name}`"), needed, limit, limit_name, help, shrinks_with_rows: true })
    }
}

/// Returns name and bytes of every resource: a buffer for one slice, a texture for the whole frame. Counted symbols are 0 until
/// fragments are counted. Where a host step sets k, the resources that steps before it use have the size for the greatest k, so that words
/// written before the step keep their positions.
pub fn resource_bytes<'a>(plan: &'a Plan, values: &Values) -> Result<Vec<(&'a str, u64)>, Error> {
    let decided = decision_of_k(plan);
    let for_any_k = decided.map(|_| values.with(SymbolId::K, plan.capacity().into()));
    let sizes = plan.resources.iter().enumerate().map(|(index, planned)| {
        let name = &planned.resource.name;
        let slice = match (&for_any_k, decided) {
            (Some(for_any_k), Some(command)) if is_used_before(plan, ResourceId(index), command) => for_any_k,
            _ => values,
        };
        let whole = planned.is_texture().then(|| slice.with_rows(slice.height()));
        let bytes = whole.as_ref().unwrap_or(slice).evaluate(&planned.words, &format!("`{name}`"))?.saturating_mul(4);
        Ok((name.as_str(), bytes))
    });
    sizes.collect()
}

/// Returns the bytes of all buffers, as [`resource_bytes`] counts them.
pub fn buffer_bytes(plan: &Plan, values: &Values) -> Result<u64, Error> {
    let sizes = resource_bytes(plan, values)?.into_iter().zip(&plan.resources);
    let buffers = sizes.filter(|(_, planned)| !planned.is_texture()).map(|((_, bytes), _)| bytes);
    Ok(buffers.fold(0, u64::saturating_add))
}

/// Returns the command of the first host step that sets k.
fn decision_of_k(plan: &Plan) -> Option<usize> {
    plan.frame.commands.iter().position(|command| match &command.action {
        Action::Host(decision) => decision.sets.contains(&SymbolId::K),
        _ => false,
    })
}

/// Whether a command before this one, or in a loop around it, uses the resource or one that is exchanged with it.
fn is_used_before(plan: &Plan, id: ResourceId, command: usize) -> bool {
    let around = plan.frame.loops.iter().filter(|looped| (looped.begin..looped.end).contains(&command));
    let end = around.map(|looped| looped.end).max().unwrap_or(command);
    let exchanged = plan.frame.exchanges.iter().filter(|pair| pair.contains(&id)).flatten();
    let ids: Vec<ResourceId> = exchanged.copied().chain([id]).collect();
    let uses = |pass: PassId| {
        let pass = &plan.passes[pass.0];
        let resources = pass.uses.iter().map(|usage| usage.resource.as_str());
        resources.filter_map(|name| plan.resource_id(name)).any(|used| ids.contains(&used))
    };
    plan.frame.commands[..end].iter().any(|command| match &command.action {
        Action::Clear { resource, .. } => ids.contains(resource),
        Action::Copy { from, to } => ids.contains(from) || ids.contains(to),
        Action::Pass(pass) => uses(*pass),
        Action::Loop(_) | Action::LoopEnd(_) | Action::Host(_) => false,
    })
}

/// Returns the most rows of a slice that fit, or 0. `height`: the rows of the frame. No number of rows may fit after one that does not.
pub fn most_rows(height: u32, fits: impl Fn(u32) -> bool) -> u32 {
    // The whole frame mostly fits.
    if height == 0 || fits(height) {
        return height;
    }
    let (mut most, mut too_many) = (0, height);
    while too_many - most > 1 {
        let middle = most + (too_many - most) / 2;
        if fits(middle) { most = middle } else { too_many = middle }
    }
    most
}
