// Lists the fluid around each boundary particle in reach of it.
#flag lists_boundary
#import storage/lists/build

// Number of boundary particles in reach, then they (storage/lists/reached.wgsl).
var<storage, read_write> reached: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn list_reached(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || !is_boundary(i) {
        return;
    }
    let x = unpack(position[i]);
    listed[i] = Listed(pack(x), pack(Vector(0.0)));
    if is_reached(i) {
        let place = reached_before(i);
        reached[1u + place] = i;
        list_around(i, parameters.free_count + place, true, x, Vector(0.0));
    }
}
