// At the end of a frame, in scenes of grains that rotate: columns that contacts give. One pass for these and for figures would
// bind too many buffers there.
#flag measuring
#import common/thread
#import physics/dem/contacts

#import fields/measured

#import physics/dem/surface

@compute @workgroup_size(GROUP_SIZE)
fn measure_columns(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        let sum = sum_contacts(i);
#if column_contacts
        contacts[i] = sum.contacts;
#end
#if column_pressure
        pressure[i] = sum.normal_force / surface_of(sum);
#end
    }
}
