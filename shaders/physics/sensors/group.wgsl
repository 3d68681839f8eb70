// Adds what the threads of a workgroup found, in a fixed order.
#import common/thread
#import physics/sensors/probe

var<workgroup> group_readings: array<Reading, GROUP_SIZE>;

// Every thread of the workgroup calls this. The sum is the first thread's.
fn group_reading(thread: Thread, kind: u32, reading: Reading) -> Reading {
    group_readings[thread.local_index] = reading;
    workgroupBarrier();
    for (var reach = GROUP_SIZE / 2u; reach > 0u; reach /= 2u) {
        if thread.local_index < reach {
            group_readings[thread.local_index] =
                add_readings(kind, group_readings[thread.local_index], group_readings[thread.local_index + reach]);
        }
        workgroupBarrier();
    }
    return group_readings[0];
}
