// Probes of single particles: what flows through a rectangle, means and extremes in a box.
#import common/parameters
#import cells/images
#import physics/fluid/boundary_particles
#import physics/sensors/field
#import physics/sensors/sweep
#if sizes
#import common/sizes
#end

// A particle's position, or that of its image in the box, where space repeats.
fn seen_at(x: Vector, probe: Probe) -> Vector {
#if periodic
    let center = 0.5 * (first(probe.lower) + first(probe.upper));
    return center + nearest_image(x - center);
#else
    return x;
#end
}

fn density_of(i: u32, probe: Probe) -> f32 {
#if several_materials
    return material_of(i).density;
#else
    return probe.density;
#end
}

fn volume_of(i: u32, probe: Probe) -> f32 {
#if sizes
    return probe.volume * mass_share(size_of(i));
#else
    return probe.volume;
#end
}

@compute @workgroup_size(GROUP_SIZE)
fn sense_particles(thread: Thread) {
    let share = share_of(thread, 0u);
    let probe = probes[min(share.probe, PARTICLE_PROBES - 1u)];
    var reading = no_reading(probe.kind);
    for (var i = share.first; i < parameters.particle_count; i += share.step) {
        let x = seen_at(unpack(position[i]), probe);
        if is_boundary(i) || any(x < first(probe.lower)) || any(x >= first(probe.upper)) {
            continue;
        }
        var found = no_reading(probe.kind);
        switch probe.kind {
            case PROBE_FLUX: {
                let away = abs(dot(x, first(probe.direction)) - probe.direction.w);
                // A hat with integral one: on a lattice its sum is exact.
                let hat = max(1.0 - away / probe.reach, 0.0) / probe.reach;
                let flow = hat * volume_of(i, probe) * dot(unpack(velocity[i]), first(probe.direction));
                found.a = vec4f(flow, density_of(i, probe) * flow, 0.0, 0.0);
            }
            case PROBE_MEAN: {
                found.a = vec4f(field_of(i, probe.field), 1.0);
            }
            default: {
                let value = field_of(i, probe.field);
                found = Reading(vec4f(value, 1.0), vec4f(value, 0.0));
            }
        }
        reading = add_readings(probe.kind, reading, found);
    }
    leave_reading(thread, share, PARTICLE_PROBES, probe.kind, reading);
}
