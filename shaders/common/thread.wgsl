// Threads and the items they work on. GROUP_SIZE threads make a workgroup (gpu/compose.rs).

struct Thread {
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local_index: u32,
}

// Workgroups may be folded into two dimensions (Pass::encode).
fn group_index(thread: Thread) -> u32 {
    return thread.group.y * thread.groups.x + thread.group.x;
}

// The item of this thread.
fn item_index(thread: Thread) -> u32 {
    return group_index(thread) * GROUP_SIZE + thread.local_index;
}
