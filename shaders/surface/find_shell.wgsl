// The kernel of each particle, and which particles are near the surface: those that stand apart from the weighted mean of their
// neighbors (Akinci et al. 2012 find them by their neighbors too). The others lie deep inside, and no voxel is made for them.
#import common/thread
#import common/vector
#import common/parameters
#import physics/present
#import physics/fluid/boundary_particles
#import <candidates>
#import surface/mirrors
#import <fit_kernel>

// Sum of weights of a particle that has neighbors on all sides, with room to spare, over the cube of the reach in spacings; amid
// the fluid it is 0.64.
const SHALLOW: f32 = 0.38;

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
    var moments = Moments();
    var sum = vec4f(0.0);
    var neighbors = 0u;
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let y = unpack(position[j]) - x;
            let distance = dot(y, y);
            neighbors += u32(distance < surface.neighbor_reach * surface.neighbor_reach && j != i);
            if distance >= square || is_boundary(j) {
                continue;
            }
            let share = 1.0 - distance / square;
            sum += share * share * share * vec4f(y, 1.0);
            add_moment(&moments, y);
        }
    }
    // Drops are drawn by themselves.
    if is_boundary(i) || f32(neighbors) < surface.fewest {
        shell_flag[i] = 0u;
        write_no_kernel(i);
        return;
    }
    for (var number = 1u; number < IMAGES; number++) {
        let image = image_of(x, number);
        if !image.is_seen {
            continue;
        }
        let beyond = voxel_of(image.at);
        for (var k = 0u; k < RANGES; k++) {
            let range = candidate_range(beyond, k);
            for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
                let j = candidate(slot);
                if !is_boundary(j) {
                    add_moment(&moments, image.direction * (unpack(position[j]) - image.at));
                }
            }
        }
    }
    // The mean of a drop, and of a sheet, is where they are.
    let reach = surface.reach / surface.spacing;
    let is_deep = length(sum.xyz) <= surface.deep * sum.w && sum.w > SHALLOW * reach * reach * reach;
    shell_flag[i] = u32(!is_deep);
    write_kernel(i, x, moments);
}
