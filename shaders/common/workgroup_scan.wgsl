// Prefix sum over one workgroup of SCAN_THREADS threads.

var<workgroup> scan_shared: array<u32, SCAN_THREADS>;

struct Scanned {
    before: u32, // sum over the threads before this one
    total: u32, // sum over all threads
}

// Every thread of the workgroup calls this (Hillis and Steele 1986).
fn workgroup_scan(thread: u32, value: u32) -> Scanned {
    scan_shared[thread] = value;
    workgroupBarrier();
    var sum = value;
    for (var reach = 1u; reach < SCAN_THREADS; reach *= 2u) {
        var left = 0u;
        if thread >= reach {
            left = scan_shared[thread - reach];
        }
        workgroupBarrier();
        sum += left;
        scan_shared[thread] = sum;
        workgroupBarrier();
    }
    let total = scan_shared[SCAN_THREADS - 1u];
    workgroupBarrier();
    return Scanned(sum - value, total);
}
