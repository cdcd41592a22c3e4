// The histogram of depth complexity (K15 sec. 4.2): bin c - 1 counts the pixels with c fragments, the last bin those
// with 1024 or more. The word after the bins sums the fragments beyond the 1024th of their pixels, so the bins and this
// word give the number of all fragments. Pixels without fragments are in no bin.
//
// A workgroup counts its 256 pixels in workgroup memory first: many pixels share a bin. It sets that memory to zero:
// only WGSL does so by itself.

const BINS = 1024u;

var<workgroup> bins: array<atomic<u32>, BINS>;
var<workgroup> beyond: atomic<u32>;

@compute @workgroup_size(16, 16)
fn build_histogram(
    @builtin(global_invocation_id) invocation: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    for (var bin = local; bin < BINS; bin += 256u) {
        atomicStore(&bins[bin], 0u);
    }
    if local == 0u {
        atomicStore(&beyond, 0u);
    }
    workgroupBarrier();
    if invocation.x < frame.width && invocation.y < frame.height {
        let position = vec2<f32>(invocation.xy + vec2<u32>(0u, frame.first_row));
        let fragments = allocation_fragments(pixel_index(position));
        if fragments > 0u {
            atomicAdd(&bins[min(fragments, BINS) - 1u], 1u);
        }
        if fragments > BINS {
            atomicAdd(&beyond, fragments - BINS);
        }
    }
    workgroupBarrier();
    for (var bin = local; bin < BINS; bin += 256u) {
        let pixels = atomicLoad(&bins[bin]);
        if pixels > 0u {
            histogram_atomic_add(bin, pixels);
        }
    }
    if local == 0u {
        let deep = atomicLoad(&beyond);
        if deep > 0u {
            histogram_atomic_add(BINS, deep);
        }
    }
}
