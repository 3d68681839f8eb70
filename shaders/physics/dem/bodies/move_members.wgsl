// Particles of rigid bodies follow these, at the velocity of their places: v + ω × r.
#flag moves
#import common/thread
#import common/parameters
#import physics/guard
#import physics/next
#import physics/dem/rest
#import physics/dem/rotation
#import physics/dem/frictional_contact
#import physics/bodies/body
#import fields/velocity/pack
#import fields/next_angular_velocity/write

// By id: the particle's place in its body, m; beside it, the body's number.
var<storage, read> member: array<vec4f>;
var<storage, read> body_state: array<BodyState>;

@compute @workgroup_size(GROUP_SIZE)
fn move_members(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || id[i] >= MEMBERS {
        return;
    }
    let place = member[id[i]];
    if place.w == 0.0 {
        return;
    }
    let body = body_state[u32(place.w) - 1u];
    let arm = turned(body.orientation, place.xyz);
    let center = first(body.center);
    let way = first(vec4f(arm + body.center_rest.xyz, 0.0));
    // See leapfrog.wgsl: no coordinate is farther, which compilers do not know.
    var moved = clamp(center + way, Vector(-contact.farthest), Vector(contact.farthest));
    let rest = way - (moved - center);
    var v = first(vec4f(body.velocity.xyz + cross(body.angular_velocity.xyz, arm), 0.0));
    watch(i, center, &moved, &v);
    leave(i, moved, pack_velocity(v, body.center.w));
    next_position[i].w = number_of_rest(moved, rest);
    next_angular_velocity[i] = vec4f(body.angular_velocity.xyz, f32(id[i] + 1u));
}
