// At the end of a frame: columns that contacts give, and figures over all grains.
#flag measuring
#import common/thread
#import physics/dem/contacts

#import fields/measured

#import physics/dem/surface
#if rotation
#import fields/angular_velocity
#end
#if statistics
#import physics/group_sums
#end

@compute @workgroup_size(GROUP_SIZE)
fn measure_grains(thread: Thread) {
    let i = item_index(thread);
    let alive = i < parameters.particle_count;
    var sum = ContactSum();
    if alive {
        sum = sum_contacts(i);
#if !rotation
#if column_contacts
        contacts[i] = sum.contacts;
#end
#if column_pressure
        pressure[i] = sum.normal_force / surface_of(sum);
#end
#end
    }
#if statistics
    var sums = Sums();
    if alive {
        let v = unpack(velocity[i]);
#if rigid_bodies
        // The host adds energies of rigid bodies.
        let loose = select(0.0, 1.0, body[i] == 0u);
#end
#if sizes
        let mass = measure.mass * mass_share(sum.size);
#else
        let mass = measure.mass;
#end
        sums.kinetic_energy = 0.5 * mass * dot(v, v);
#if rotation
#if sizes
        let inertia = contact.inertia * inertia_share(sum.size);
#else
        let inertia = contact.inertia;
#end
        let w = length(unpack_rotation(angular_velocity[i]));
        sums.kinetic_energy += 0.5 * inertia * w * w;
#end
        sums.potential_energy =
            -mass * dot(first(parameters.gravity), unpack(position[i]) - first(measure.reference));
#if rigid_bodies
        sums.kinetic_energy *= loose;
        sums.potential_energy *= loose;
#end
        sums.max_speed = length(v);
#if sizes
        // In radii of the grain; of two, that is more for the smaller one. The host divides by the largest radius.
        sums.max_overlap = sum.overlap / sum.size;
#else
        sums.max_overlap = sum.overlap;
#end
        sums.contacts = sum.contacts;
    }
    sum_group(thread, sums);
#end
}
