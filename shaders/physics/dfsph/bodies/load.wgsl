// Sums over the particles of a body: a workgroup for each body, and for more of them where there are fewer workgroups. Sums
// are a fixed tree over ids, so that they do not depend on where particles stand.
#import common/thread

struct Load {
    force: vec3f, // N s
    torque: vec3f, // about the center of mass, N m s
}

var<workgroup> loads: array<Load, GROUP_SIZE>;

// Every thread of the workgroup calls this, and gets the sum.
fn sum_loads(thread: Thread, own: Load) -> Load {
    loads[thread.local_index] = own;
    workgroupBarrier();
    for (var reach = GROUP_SIZE / 2u; reach > 0u; reach /= 2u) {
        if thread.local_index < reach {
            loads[thread.local_index].force += loads[thread.local_index + reach].force;
            loads[thread.local_index].torque += loads[thread.local_index + reach].torque;
        }
        workgroupBarrier();
    }
    let sum = loads[0];
    workgroupBarrier();
    return sum;
}
