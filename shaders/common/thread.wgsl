// Threads and the items they work on.

// Threads of a workgroup, in passes over particles or voxels.
const GROUP_SIZE: u32 = 64u;

// The item of this thread, when workgroups were folded into two dimensions (Pass::encode).
fn thread_index(group: vec3u, groups: vec3u, local_index: u32) -> u32 {
    return (group.y * groups.x + group.x) * GROUP_SIZE + local_index;
}
