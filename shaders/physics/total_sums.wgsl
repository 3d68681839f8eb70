// Adds the workgroups' sums, in a fixed order.
#import common/thread
#import common/parameters
#import physics/sums

const TOTAL_THREADS: u32 = 256u;

var<storage, read> partial_sums: array<Sums>;
var<storage, read_write> sums: Sums;
var<workgroup> thread_sums: array<Sums, TOTAL_THREADS>;

// One workgroup.
@compute @workgroup_size(TOTAL_THREADS)
fn total_sums(@builtin(local_invocation_index) thread: u32) {
    let groups = (parameters.particle_count + GROUP_SIZE - 1u) / GROUP_SIZE;
    var total = Sums();
    for (var group = thread; group < groups; group += TOTAL_THREADS) {
        total = add_sums(total, partial_sums[group]);
    }
    thread_sums[thread] = total;
    workgroupBarrier();
    for (var reach = TOTAL_THREADS / 2u; reach > 0u; reach /= 2u) {
        if thread < reach {
            thread_sums[thread] = add_sums(thread_sums[thread], thread_sums[thread + reach]);
        }
        workgroupBarrier();
    }
    if thread == 0u {
        sums = thread_sums[0];
    }
}
