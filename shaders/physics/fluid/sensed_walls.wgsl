// Boundary particles of the body that the probe of a force asks for.
#import common/parameters
#import physics/present
#import physics/fluid/boundary_particles
#import physics/sensors/target
#if boundary_particles
#import physics/fluid/wall_motion
#end

fn is_sensed(j: u32) -> bool {
#if boundary_particles
    if !is_boundary(j) {
        return false;
    }
    let body = boundary[id[j] - parameters.first_boundary].w;
    if body < 0.0 {
        return is_sensed_side(unpack(position[j]));
    }
    return sensed.target_body == u32(body);
#else
    return false;
#end
}
