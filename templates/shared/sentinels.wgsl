// Values that no fragment has.

/// The key of a slot without a fragment. It is greater than every key: bits of a depth end at 0x3f800000, ordered bits
/// of any other number at 0xff800000.
const EMPTY = 0xffffffffu;

/// The cursor behind the last fragment of a pixel.
const END = 0xffffffffu;
