// Extents while they are found: lowest above highest where there is nothing (neighbors::addressing).
const NOTHING_BELOW: i32 = 0x7fffffff;
const NOTHING_ABOVE: i32 = -0x7fffffff;
