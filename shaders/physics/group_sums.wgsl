// Adds figures of a workgroup's particles.
#import common/thread
#import physics/sums

var<storage, read_write> partial_sums: array<Sums>;
var<workgroup> group_sums: array<Sums, GROUP_SIZE>;

// Every thread of the workgroup calls this. A fixed tree, so that two runs add in the same order.
fn sum_group(thread: Thread, sums: Sums) {
    group_sums[thread.local_index] = sums;
    workgroupBarrier();
    for (var reach = GROUP_SIZE / 2u; reach > 0u; reach /= 2u) {
        if thread.local_index < reach {
            group_sums[thread.local_index] =
                add_sums(group_sums[thread.local_index], group_sums[thread.local_index + reach]);
        }
        workgroupBarrier();
    }
    if thread.local_index == 0u {
        partial_sums[group_index(thread)] = group_sums[0];
    }
}
