// Probes that go over all particles: SENSOR_PARTS workgroups for each of them, whose readings are added in a fixed order.
#import common/thread
#import physics/sensors/group
#import physics/sensors/probe

// SENSOR_PARTS of each probe.
var<storage, read_write> partial_readings: array<Reading>;

struct Share {
    probe: u32, // number among the probes
    part: u32,
    first: u32, // the first particle of this thread
    step: u32, // from one of its particles to the next
}

// What this thread does for probes that are numbered from `first_probe` on.
fn share_of(thread: Thread, first_probe: u32) -> Share {
    let group = group_index(thread);
    let part = group % SENSOR_PARTS;
    return Share(
        first_probe + group / SENSOR_PARTS,
        part,
        part * GROUP_SIZE + thread.local_index,
        SENSOR_PARTS * GROUP_SIZE,
    );
}

// Every thread of the workgroup calls this. `probe_end` is the number behind the last probe; where groups are folded, some
// have no probe.
fn leave_reading(thread: Thread, share: Share, probe_end: u32, kind: u32, reading: Reading) {
    let sum = group_reading(thread, kind, reading);
    if thread.local_index == 0u && share.probe < probe_end {
        partial_readings[share.probe * SENSOR_PARTS + share.part] = sum;
    }
}
