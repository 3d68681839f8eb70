// Where a step left the particles for the search, m.
#import common/vector

var<storage, read> next_position: array<Packed>;
