// Forces and torques of all contacts, and what these remember.
#flag moves
#import common/thread
#import physics/dem/contacts
#import physics/dem/motion
#import physics/time_step

// m/s² with the length of the step beside it, s; rad/s² with the number of contacts beside it.
var<storage, read_write> contact_acceleration: array<Motion>;

@compute @workgroup_size(GROUP_SIZE)
fn sum_contact_forces(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let sum = sum_contacts(i);
    end_slots(i, sum.slots);
#if rigid_bodies
    // Of a body's particle, what its body feels by it, without what acts on the body as a whole. The number says that too.
    if body[i] != 0u {
        contact_acceleration[i] = Motion(
            pack(contact.inverse_mass * sum.force),
            pack_rotation(contact.inverse_mass * sum.torque, -1.0 - f32(sum.slots)),
        );
        return;
    }
#end
    let acceleration = acceleration_of(sum, unpack(velocity[i]));
#if sizes
    let inverse_inertia = contact.inverse_inertia / inertia_share(sum.size);
#else
    let inverse_inertia = contact.inverse_inertia;
#end
    contact_acceleration[i] = Motion(
        pack_with(acceleration, time_step()),
        pack_rotation(inverse_inertia * sum.torque, f32(sum.slots)),
    );
}
