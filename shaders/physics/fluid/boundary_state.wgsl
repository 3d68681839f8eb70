// Boundary particles take on the pressure and the velocity of the fluid beside them (Adami 2012, Eq. 22 to 27).
#flag writes_state
#import common/thread
#import physics/fluid/pairs
#import physics/fluid/beside
#import physics/fluid/numbered

@compute @workgroup_size(GROUP_SIZE)
fn extend_to_boundary(thread: Thread) {
    let number = item_index(thread);
    let i = numbered_particle(number);
    if i >= parameters.particle_count {
        return;
    }
    let v = unpack(velocity[i]);
    if !is_boundary(i) {
#if viscous_velocities
        viscous_velocity[i] = pack(v);
#end
        return;
    }
    let x = unpack(position[i]);
    var beside = Beside();
    let home = around(number, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = toward(x, j);
            if within(s, fluid.support) && !is_boundary(j) {
                let weight = kernel(length(s));
                let state = fluid_state[j];
                let other = material_of(j);
                beside.weights += weight;
                beside.pressure += weight * state.y;
                beside.weight_moment += (weight * other.density * (1.0 + state.x)) * s;
                beside.stiffness += weight * other.stiffness;
#if viscous_velocities
                beside.velocity += weight * unpack(velocity[j]);
#end
            }
        }
    }
    extend(i, x, v, beside);
}
