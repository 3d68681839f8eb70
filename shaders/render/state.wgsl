// The particles: the simulation's own buffers.

#import common/vector

var<storage, read> position: array<Packed>;
var<storage, read> velocity: array<Packed>;
var<storage, read> id: array<u32>;
