// Indices of the words of the buffer `counters`.

const GENERATED = 0u;
const CULLED = 1u;
const DISPLACED = 2u;
const POOL_EXHAUSTED = 3u;
const TIMED_OUT = 4u;
const LAYERS_EXCEEDED = 5u;
const EQUAL_KEYS = 6u;
const EMITTED = 7u;
const OUT_OF_ORDER = 8u;
const PAGES_LEAKED = 9u;
const NOT_CONVERGED = 10u;
const SAMPLES_EXHAUSTED = 11u;
const OCCLUDED = 12u;
const PARTIAL_COVERAGE = 13u;
