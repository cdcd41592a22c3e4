// Values that no fragment has.

/// The key of an empty slot. It is greater than every key: the greatest bits of a depth are 0x3f800000, and the
/// greatest ordered bits of any other number 0xff800000.
const EMPTY = 0xffffffffu;

/// The cursor past the last fragment of a pixel.
const END = 0xffffffffu;
