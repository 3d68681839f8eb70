// What no step changes, for the next search. A search without room is made again from what stood there before, so this comes
// last.
#import common/thread
#import common/parameters
#import fields/keep

@compute @workgroup_size(GROUP_SIZE)
fn keep_fields(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        keep(i);
    }
}
