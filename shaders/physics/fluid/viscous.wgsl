// The velocity of a neighbor that viscous forces see; v is its own.
#if viscous_velocities
var<storage, read> viscous_velocity: array<Packed>;

fn viscous(j: u32, v: Vector) -> Vector {
    return unpack(viscous_velocity[j]);
}
#else
fn viscous(j: u32, v: Vector) -> Vector {
    return v;
}
#end
