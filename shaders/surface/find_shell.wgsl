// Which particles are near the surface: those that stand apart from the weighted mean of their neighbors (Akinci et al. 2012
// find them by their neighbors too). The others lie deep inside, and no voxel is made for them.
#import common/thread
#import common/parameters
#import surface/implicit

var<storage, read_write> shell_flag: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn find_shell(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
    let home = voxel_of(x);
    let square = surface.reach * surface.reach;
    var sum = vec4f(0.0);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let y = unpack(position[j]) - x;
            let share = select(max(1.0 - dot(y, y) / square, 0.0), 0.0, is_boundary(j));
            sum += share * share * share * vec4f(y, 1.0);
        }
    }
    shell_flag[i] = u32(!is_boundary(i) && length(sum.xyz) > surface.deep * sum.w);
}
