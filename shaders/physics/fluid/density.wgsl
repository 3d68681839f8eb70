// Density and pressure of each particle of the fluid. Each formula is a file of `physics/fluid/density/` and a row of
// `src/physics/formulas.rs`; `physics/fluid/forces.wgsl` says what such a file holds. Here it may also have
// NAME_limit(own, &density), which changes the new density.
#flag writes_state
#import common/thread
#import physics/time_step
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#import physics/fluid/pair_state
#if planes
#import physics/fluid/planes
#end
#import physics/fluid/density_deviation
#each density
#import <density>
#end

struct Density {
    rate: f32, // of ρ/ρ₀, 1/s
    deviation: f32, // ρ/ρ₀ − 1 at the step's end
#each density {Density}
    {density}: {Density},
#end
}

// The particle whose density is sought.
struct Own {
    index: u32,
    velocity: Vector, // m/s
    deviation: f32, // before the step
}

// A particle near it, or a cell beyond a plane, which counts as a wall's particle.
struct Neighbor {
    index: u32, // of a cell: that of the particle itself
    s: Vector, // from the particle to its neighbor, m
    r: f32, // its length, m
    share: f32, // of it that is there
    weight: f32, // its volume times the kernel's slope; the gradient of W is −s times the slope
    deviation: f32,
    velocity: Vector, // m/s
    wall: bool,
}

@compute @workgroup_size(GROUP_SIZE)
fn find_density(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || is_boundary(i) {
        return;
    }
    let x = unpack(position[i]);
    let made_of = material_of(i);
    let deviation = deviation_before(i);
    let own = Own(i, unpack(velocity[i]), deviation);
    var density = Density();
    density.deviation = own.deviation;
#each density {density}_begin
    {density}_begin(own, &density);
#end
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = toward(x, j);
            if within(s, fluid.support) && j != i {
                let other = neighbor_at(j, s);
#each density {density}_pair
                {density}_pair(own, other, &density);
#end
            }
        }
    }
#if planes
    let cells = cells_beyond(x);
    for (var number = 0u; number < cells; number++) {
        let other = neighbor_beyond(own, beyond(x, number));
#each density {density}_pair
        {density}_pair(own, other, &density);
#end
    }
#end
#each density {density}_end
    {density}_end(own, &density);
#end
    density.deviation += time_step() * density.rate;
#each density {density}_limit
    {density}_limit(own, &density);
#end
    let pressure = pressure_at(made_of.stiffness, density.deviation);
    let state = vec2f(density.deviation, allowed_pressure(pressure));
    fluid_state[i] = state;
    pair_state[i] = pair_state_of(x, own.velocity, state);
}

fn neighbor_at(j: u32, s: Vector) -> Neighbor {
    let wall = is_boundary(j);
    let r = length(s);
    let deviation = deviation_before(j);
    let weight = volume_at(deviation) * kernel_slope(r);
    return Neighbor(j, s, r, 1.0, weight, deviation, unpack(velocity[j]), wall);
}

#if planes
fn neighbor_beyond(own: Own, cell: Beyond) -> Neighbor {
    let r = length(cell.offset);
    let weight = cell.share * volume_at(own.deviation) * kernel_slope(r);
    return Neighbor(own.index, cell.offset, r, cell.share, weight, own.deviation, cell.velocity, true);
}
#end
