//! Runs the helper invocations beside the last column and beside the first and last row of a slice, as GPUs do: shaders run in
//! quads of 2 x 2 pixels.
//!
//! The fragments of a tile run first, so helper invocations find what they left in memory. Quads inside of the slice have
//! helper invocations too, but those run at pixels of the slice, where fragments run as well.

use std::ops::Range;

use fragbuf_interpreter::{Access, Event, Exit, Machine, Operation, Reply, SharedMemory, WordAddress};

use crate::fragment_stage::FragmentPosition;
use crate::fragments::FragmentBatch;
use crate::tile::Bin;
use crate::triangle::PIXEL_CENTRE;
use crate::view::View;

/// Memory that a helper invocation reads and does not change.
struct Unchanged<'v, 'a>(&'v View<'a>);

impl SharedMemory for Unchanged<'_, '_> {
    fn length(&self, buffer: u16) -> u32 {
        self.0.length(buffer)
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.0.constant(address)
    }

    fn texel(&self, texture: u16, coordinates: [u32; 3]) -> Option<[u32; 4]> {
        self.0.texel(texture, coordinates)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.0.extent(texture)
    }

    fn event(&mut self, event: &Event) -> Reply {
        match event {
            Event::Access(access) => Reply::Done(self.0.access(&Access { operation: Operation::Load, ..*access })),
            Event::Barrier(_) => Reply::Stop,
            Event::Fence | Event::CriticalBegin | Event::CriticalEnd => Reply::Done(0),
        }
    }
}

impl<'a> FragmentBatch<'a> {
    /// Runs the helper invocations of a tile that are outside of the slice. They may read out of bounds, which has no effect.
    pub(crate) fn run_helpers(&self, bin: &Bin, machine: &mut Machine<'a>, view: &View<'_>) {
        let (width, rows) = (self.draw.size.0, &self.draw.rows);
        let [_, x1, y0, y1] = bin.rectangle;
        let is_right = x1 == width && width % 2 == 1;
        let is_top = y0 == rows.start && y0 % 2 == 1;
        let is_bottom = y1 == rows.end && y1 % 2 == 1;
        if !is_right && !is_top && !is_bottom {
            return;
        }
        machine.is_helper = true;
        self.for_each_fragment(bin, |triangle, position| {
            for [x, y] in outside_of_slice([position.x, position.y], width, rows) {
                if self.results.endless.at().is_some() {
                    return;
                }
                let weights = triangle.weights(x, y, PIXEL_CENTRE);
                self.stage.begin(machine, triangle, &FragmentPosition { x, y, weights, mask: 0, ..position });
                if machine.run(&mut Unchanged(view)) == Exit::Endless {
                    self.results.endless.set(machine.at());
                }
                machine.out_of_bounds = None;
            }
        });
        machine.is_helper = false;
    }
}

/// Returns the pixels outside of the slice that share an edge and a quad with this pixel and, if there are two, the one
/// between them.
fn outside_of_slice([x, y]: [u32; 2], width: u32, rows: &Range<u32>) -> impl Iterator<Item = [u32; 2]> {
    let (is_beside, is_below) = ((x ^ 1) >= width, !rows.contains(&(y ^ 1)));
    let beside = is_beside.then_some([x ^ 1, y]);
    let below = is_below.then_some([x, y ^ 1]);
    let between = (is_beside && is_below).then_some([x ^ 1, y ^ 1]);
    [beside, below, between].into_iter().flatten()
}
