// Rigid bodies at the end of a step, and their particles with them. Turning keeps angular momentum: the orientation turns by
// dt ω, where ω is what the momentum means in the orientation of half a step later, which two iterations find (explicit midpoint
// Lie algorithm of Krysl and Endres 2005).
#flag moves
#import common/thread
#import physics/time_step
#import physics/guard
#if adaptive_step
#import common/parameters
#import physics/extremes
#end
#import physics/dfsph/bodies/motion
#import fields/position
#import fields/next_position/write
#import fields/next_velocity/write

var<storage, read> member: array<Member>;

// More than any coordinate, m. Without this bound compilers may find that a sum less one of its parts is the other part.
const FARTHEST: f32 = 1e9;

fn moved(shape: BodyShape, before: BodyState, dt: f32) -> BodyState {
    var body = before;
    let way = dt * before.velocity.xyz + before.center_rest.xyz;
    let center = clamp(before.center.xyz + way, vec3f(-FARTHEST), vec3f(FARTHEST));
    body.center = vec4f(center, before.center.w);
    body.center_rest = vec4f(way - (center - before.center.xyz), 0.0);
    let q = before.orientation;
    let momentum = before.half_momentum.xyz;
    var rate = before.angular_velocity.xyz;
    for (var iteration = 0u; iteration < 2u; iteration++) {
        rate = angular_velocity_of(shape, q + turning(q, 0.5 * dt * rate), momentum);
    }
    // Rounding makes it longer or shorter, little by little.
    let off = 1.0 - dot(q, q);
    let turn = turning(q, dt * rate) + before.orientation_rest + select(0.0, 0.5 * off, abs(off) > 1e-6) * q;
    let orientation = clamp(q + turn, vec4f(-FARTHEST), vec4f(FARTHEST));
    body.orientation = orientation;
    body.orientation_rest = turn - (orientation - q);
    body.angular_velocity = vec4f(angular_velocity_of(shape, orientation, momentum), 0.0);
    return body;
}

@compute @workgroup_size(GROUP_SIZE)
fn move_bodies(thread: Thread) {
    let step = thread.groups.x * thread.groups.y;
    for (var b = group_index(thread); b < RIGID_BODIES; b += step) {
        let shape = body_shape[b];
        let body = moved(shape, body_state[b], time_step());
        workgroupBarrier();
        if thread.local_index == 0u {
            body_state[b] = body;
        }
        for (var k = thread.local_index; k < shape.count; k += GROUP_SIZE) {
            let mine = member[shape.first + k];
            let arm = turned(body.orientation, mine.place.xyz) + body.center_rest.xyz;
            var x = first(vec4f(body.center.xyz + arm, 0.0));
            var v = velocity_at(body, mine.place.xyz);
            watch(mine.slot, unpack(position[mine.slot]), &x, &v);
#if adaptive_step
            note_extremes(first(parameters.gravity), length(v), 0.0);
#end
            next_position[mine.slot] = pack(x);
            next_velocity[mine.slot] = pack(v);
        }
    }
}
