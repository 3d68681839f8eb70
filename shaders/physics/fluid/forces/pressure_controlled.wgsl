// Makes the symmetric pressure force, inside of the fluid and where the particle's pressure is negative, one of differences,
// which cannot clump particles (Sun 2018). Where the kernel reaches beyond a free surface, a difference would not vanish with
// even pressure.

// Shares of a particle's neighborhood that are there, from symmetric to controlled.
const CONTROLLED = vec2f(0.9, 0.97);

fn pressure_controlled_end(own: Own, forces: ptr<function, Forces>) {
    let around = forces.surroundings;
    forces.push += (ramp(CONTROLLED, around) * 2.0 * min(own.pressure, 0.0)) * around.inside;
}
