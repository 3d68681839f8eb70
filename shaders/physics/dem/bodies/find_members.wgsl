// Where the particles of rigid bodies stand behind a search, by id.
#import common/thread
#import common/parameters
#import fields/id

var<storage, read_write> member_slot: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn find_members(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count && id[i] < MEMBERS {
        member_slot[id[i]] = i;
    }
}
