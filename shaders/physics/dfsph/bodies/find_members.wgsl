// Behind each search: where the particles of rigid bodies stand.
#import common/thread
#import common/parameters
#import fields/id
#import physics/dfsph/bodies/numbers
#import physics/dfsph/bodies/member

var<storage, read_write> member: array<Member>;

@compute @workgroup_size(GROUP_SIZE)
fn find_members(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let number = member_number(id[i]);
    if number < MEMBERS {
        member[number].slot = i;
    }
}
