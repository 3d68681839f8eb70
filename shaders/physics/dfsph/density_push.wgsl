// What the impulses of the loop of density do to the way that particles go.
#flag moves
#import physics/dfsph/push

var<storage, read> impulse: array<f32>; // of the last iteration, Pa·s
var<storage, read_write> next_position: array<Packed>; // w: the pressure's remainder, Pa

@compute @workgroup_size(GROUP_SIZE)
fn push_apart(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        let way = next_position[i];
        next_position[i] = pack_with(unpack(way) + push_on(i, 1.0), number_of(way));
    }
}
