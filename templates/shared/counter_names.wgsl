// Words of the buffer `counters`.

const GENERATED = 0u;
const CULLED = 1u;
const DISPLACED = 2u;
const POOL_EXHAUSTED = 3u;
const SPIN_EXHAUSTED = 4u;
const LAYERS_EXCEEDED = 5u;
const EQUAL_KEYS = 6u;
const UNSETTLED = 7u;
const SAMPLES_EXHAUSTED = 8u;
