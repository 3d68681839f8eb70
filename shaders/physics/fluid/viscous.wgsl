// The velocity of a neighbor that viscous forces see.
#if viscous_velocities
var<storage, read> viscous_velocity: array<Packed>;

fn viscous(j: u32) -> Vector {
    return unpack(viscous_velocity[j]);
}
#else
fn viscous(j: u32) -> Vector {
    return unpack(velocity[j]);
}
#end
