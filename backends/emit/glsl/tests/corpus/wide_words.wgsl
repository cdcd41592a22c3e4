@group(0) @binding(0) var<storage, read_write> words: array<atomic<u64>>;
@group(0) @binding(1) var<storage, read_write> plain: array<u64>;
@group(0) @binding(2) var<storage, read_write> narrow: array<u32>;
const NOTHING = 0xfffffffffffffffflu;
struct Pair {
    wide: u64,
    narrow: u32,
}

fn pack(high: u32, low: u32) -> u64 {
    return (u64(high) << 32u) | u64(low);
}

fn shifted(value: u64, by: u32) -> u64 {
    return (value >> by) ^ (value << (by & 63u));
}

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) i: u32) {
    var carried = pack(narrow[i], i);
    for (var slot = 0u; slot < 8u; slot++) {
        carried = max(carried, atomicMin(&words[slot], carried));
        if carried == NOTHING {
            return;
        }
    }
    let kept = atomicMax(&words[8], carried) + atomicAdd(&words[9], 1lu) + atomicSub(&words[10], carried);
    let bits = atomicAnd(&words[11], 255lu) | atomicOr(&words[12], kept) | atomicXor(&words[13], 1lu);
    let other = atomicExchange(&words[14], bits);
    let exchange = atomicCompareExchangeWeak(&words[15], other, min(bits, kept));
    if exchange.exchanged {
        plain[0] = exchange.old_value;
    }
    atomicStore(&words[16], shifted(other, i));
    var pair = Pair(atomicLoad(&words[17]), u32(kept >> 32u));
    pair.wide = select(pair.wide, 7lu, pair.wide < other) / 3lu % 10lu;
    plain[1] = clamp(pair.wide, 1lu, 9lu);
    narrow[1] = u32(pair.wide) + pair.narrow;
}
