// entry: main; fragments: 2,3; sc: livelock; relaxed: livelock
// why: Invocations swap tokens with the slot until they get token 9, which does not exist. Memory changes for ever, so this is no wait for a value.
// after: exchanger (elimination array, Hendler, Shavit and Yerushalmi 2004) with a wrong token
@group(0) @binding(0) var<storage, read_write> slot: atomic<u32>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    var mine = id.x + 1u;
    loop { mine = atomicExchange(&slot, mine); if mine == 9u { break; } }
}
