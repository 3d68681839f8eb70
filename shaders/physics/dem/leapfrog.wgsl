// Velocity Verlet in the form of a leapfrog: velocities half a step later jump over positions.
//
// v(n+½) = v(n−½) + a(n) dt, x(n+1) = x(n) + v(n+½) dt. What dashpots, and everybody else, see as the velocity at x(n+1) is
// v(n+½) + a(n) dt/2, of second order too. Beside v(n−½) stands the length of the step before; a grain that has just come
// had none, and gets half a kick. What rounding takes from a way is kept for the next one (Kahan 1965), or grains at rest
// would seem to move at a speed that is too low to move them.
#flag moves
#import common/thread
#import common/parameters
#import physics/guard
#import physics/next
#import physics/dem/rest
#import physics/dem/frictional_contact
#import fields/half_step
#import fields/next_half_step/write
#if adaptive_step
#import physics/extremes
#end

var<storage, read> contact_acceleration: array<Motion>;

@compute @workgroup_size(GROUP_SIZE)
fn leap_grains(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
#if rigid_bodies
    // Particles of rigid bodies follow these.
    let slots = number_of(contact_acceleration[i].angular);
    if slots < 0.0 {
        if -1.0 - slots > f32(CONTACT_SLOTS) {
            note_accident(i, GUARD_CROWDED, x, Vector(0.0));
        }
        next_half_step[i] = HalfStep();
        return;
    }
#end
    let a = unpack(contact_acceleration[i].linear);
    let dt = number_of(contact_acceleration[i].linear);
    let before = half_step[i].velocity;
    var v = unpack(before) + 0.5 * (number_of(before) + dt) * a;
    let way = dt * v + unpack(half_step[i].rest);
    // No coordinate is farther, which compilers do not know: they would make `way` of `(x + way) - x`.
    var moved = clamp(x + way, Vector(-contact.farthest), Vector(contact.farthest));
    let rest = way - (moved - x);
    watch(i, x, &moved, &v);
    // It touches more than it can remember.
    if number_of(contact_acceleration[i].angular) > f32(CONTACT_SLOTS) {
        note_accident(i, GUARD_CROWDED, x, v);
    }
    next_half_step[i].velocity = pack_with(v, dt);
    next_half_step[i].rest = pack(rest);
    leave(i, moved, pack(v + 0.5 * dt * a));
    next_position[i].w = number_of_rest(moved, rest);
#if adaptive_step
    note_extremes(a, length(v), 0.0);
#end
}
