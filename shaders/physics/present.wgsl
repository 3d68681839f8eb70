// The particles as the search left them.
#import common/vector

var<storage, read> position: array<Packed>;
var<storage, read> velocity: array<Packed>;
var<storage, read> id: array<u32>;
