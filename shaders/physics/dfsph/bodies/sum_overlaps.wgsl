// How far each rigid body overlaps what it touches, all contacts together: each contact gets its share of one spring, so that a
// face is as stiff as a corner.
#import common/thread
#import physics/dfsph/bodies/load
#import physics/dfsph/bodies/contact
#import physics/bodies/body

var<storage, read_write> member: array<Member>;
var<storage, read> body_shape: array<BodyShape>;

fn overlaps_of(shape: BodyShape, body: u32, thread: u32) -> f32 {
    var sum = 0.0;
    for (var k = thread; k < shape.count; k += GROUP_SIZE) {
        let number = shape.first + k;
        let mine = member[number].slot;
        let x = unpack(position[mine]);
        let range = touching(number, mine);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            if has_contact(body, j) {
                sum += overlap(toward(x, j));
            }
        }
        sum += dot(abs(overlap_with_sides(x)), Vector(1.0));
    }
    return sum;
}

@compute @workgroup_size(GROUP_SIZE)
fn sum_overlaps(thread: Thread) {
    let step = thread.groups.x * thread.groups.y;
    for (var b = group_index(thread); b < RIGID_BODIES; b += step) {
        let shape = body_shape[b];
        let own = overlaps_of(shape, b, thread.local_index);
        let sum = sum_loads(thread, Load(vec3f(own, 0.0, 0.0), vec3f(0.0))).force.x;
        for (var k = thread.local_index; k < shape.count; k += GROUP_SIZE) {
            member[shape.first + k].overlaps = sum;
        }
    }
}
