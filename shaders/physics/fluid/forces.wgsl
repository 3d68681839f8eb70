// Forces on a particle of the fluid. Each formula is a file of `physics/fluid/forces/` and a row of
// `src/physics/formulas.rs`, whose functions are called here in the order of those rows. The file of a formula NAME may have
// - a struct NAME, for sums over neighbors, which begin at zero;
// - NAME_begin(own, &forces), NAME_pair(own, other, &forces) for each neighbor, and NAME_end(own, &forces).
// Knows nothing of the grid behind `<candidates>`.
#import physics/time_step
#import physics/fluid/pairs
#import physics/fluid/apart
#import physics/fluid/material
#import physics/fluid/state
#import physics/fluid/pair_state
#import physics/fluid/viscous
#import physics/fluid/slip
#if matrices
#import physics/fluid/correction
#end
#if planes
#import physics/fluid/planes
#end
#each force
#import <force>
#end

struct Forces {
    acceleration: Vector, // m/s²
    push: Vector, // of pressure, N/m³
    drag: Vector, // of viscosity, N/m³
#each force {Force}
    {force}: {Force},
#end
}

// The particle that forces act on.
struct Own {
    index: u32,
    velocity: Vector, // m/s
    deviation: f32, // ρ/ρ₀ − 1
    pressure: f32, // Pa
    material: Material,
    density: f32, // kg/m³
}

// A particle near it, or a cell beyond a plane, which counts as a wall's particle.
struct Neighbor {
    index: u32, // of a cell: that of the particle itself
    s: Vector, // from the particle to its neighbor, m
    r: f32, // its length, m
    volume: f32, // m³
    weight: f32, // the volume times the kernel's slope; the gradient of W is −s times the slope
    deviation: f32,
    pressure: f32, // Pa
    material: Material,
    velocity: Vector, // m/s
    viscous: Vector, // velocity that viscous forces see, m/s
    stretch: f32, // differences of velocity count so many times
    wall: bool,
    beyond: bool, // a plane
}

fn forces_on(i: u32) -> Forces {
    let mine = pair_state_at(i);
    let x = unpack(mine.place);
    let own = own_at(i, mine);
    var forces = Forces();
#each force {force}_begin
    {force}_begin(own, &forces);
#end
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let theirs = pair_state_at(j);
            let s = nearest_image(unpack(theirs.place) - x);
#if of_one_body
            if within(s, fluid.support) && is_sensed(j) {
#else
            if within(s, fluid.support) && j != i {
#end
                let other = neighbor_at(j, apart(s, i, j), theirs);
#each force {force}_pair
                {force}_pair(own, other, &forces);
#end
            }
        }
    }
#if planes
    let cells = cells_beyond(x);
    for (var number = 0u; number < cells; number++) {
        var cell = beyond(x, number);
#if of_one_body
        cell.share *= select(0.0, 1.0, is_sensed_side(x + cell.offset));
#end
        let other = neighbor_beyond(own, cell);
#each force {force}_pair
        {force}_pair(own, other, &forces);
#end
    }
#end
#each force {force}_end
    {force}_end(own, &forces);
#end
    forces.acceleration = (forces.push + forces.drag) / own.density;
#if !of_one_body
    forces.acceleration += first(parameters.gravity);
#end
    return forces;
}

fn own_at(i: u32, state: PairState) -> Own {
    let made_of = material_of(i);
    let deviation = number_of(state.place);
    let density = made_of.density * (1.0 + deviation);
    return Own(i, unpack(state.motion), deviation, number_of(state.motion), made_of, density);
}

fn neighbor_at(j: u32, s: Vector, state: PairState) -> Neighbor {
    var other = Neighbor();
    other.index = j;
    other.s = s;
    other.r = length(s);
    other.deviation = number_of(state.place);
    other.volume = volume_at(other.deviation);
    other.weight = other.volume * kernel_slope(other.r);
    other.pressure = number_of(state.motion);
    other.material = material_of(j);
    other.velocity = unpack(state.motion);
    other.viscous = viscous(j, other.velocity);
    other.stretch = 1.0;
    other.wall = is_boundary(j);
    return other;
}

#if planes
fn neighbor_beyond(own: Own, cell: Beyond) -> Neighbor {
    var other = Neighbor();
    other.index = own.index;
    other.s = cell.offset;
    other.r = length(cell.offset);
    other.volume = cell.share * volume_at(own.deviation);
    other.weight = other.volume * kernel_slope(other.r);
    other.deviation = own.deviation;
    let weight_of_column = dot(first(parameters.gravity) * first(fluid.closed), cell.offset);
    other.pressure = allowed_pressure(own.pressure + own.density * weight_of_column);
    other.material = own.material;
    other.velocity = cell.velocity;
    other.viscous = cell.velocity;
    other.stretch = cell.stretch;
    other.wall = true;
    other.beyond = true;
    return other;
}
#end
