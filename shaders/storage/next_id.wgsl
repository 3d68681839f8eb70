// Numbers of the particles that a step left for the search.

var<storage, read> next_id: array<u32>;
