// The loop of implicit viscosity: what it keeps of each particle, and of itself.
#import common/vector
#import physics/dfsph/loop

struct Damping {
    strength: f32, // time step times kinematic viscosity, m²
    step: f32, // factor of what is left in a sweep
    radius: f32, // largest share of an error that such a step alone would leave
    weight: f32, // of the next first sweep
    next_weight: f32, // of the next second one
    rounding: f32, // what may be left in any case, in units of `dfsph.speed`
    first: f32, // mean of what viscosity had to change, in the same units
}

// Sections of the buffer `damped`, since a pass may bind only so many buffers.
const DAMPED: u32 = 0u; // velocity after an even number of sweeps, m/s
const DAMPED_AGAIN: u32 = 1u; // after an odd number
const FORCED: u32 = 2u; // after all forces but viscosity and pressure
#if wall_shear
const WALL_MOTION: u32 = 3u; // what moving walls add to the sums over pairs, 1/(m s)
const WALL_COLUMNS: u32 = 4u; // and on, the columns of the matrix that resting walls multiply the velocity by, 1/m²
#end

fn section(number: u32) -> u32 {
    return number * loop_count();
}
