// Prefix sum over one workgroup of SCAN_THREADS threads.

// Threads whose values one thread sums up. Each takes RAKE values by itself: a few serial sums need four barriers where
// doubling (Hillis and Steele 1986) needs eighteen, and barriers are what software adapters are slowest at.
const RAKE: u32 = 16u;

var<workgroup> scan_shared: array<u32, SCAN_THREADS>;
var<workgroup> scan_rakes: array<u32, SCAN_THREADS / RAKE + 1u>;

struct Scanned {
    before: u32, // sum over the threads before this one
    total: u32, // sum over all threads
}

// Every thread of the workgroup calls this.
fn workgroup_scan(thread: u32, value: u32) -> Scanned {
    scan_shared[thread] = value;
    workgroupBarrier();
    if thread < SCAN_THREADS / RAKE {
        var sum = 0u;
        for (var at = thread * RAKE; at < (thread + 1u) * RAKE; at++) {
            let before = sum;
            sum += scan_shared[at];
            scan_shared[at] = before;
        }
        scan_rakes[thread] = sum;
    }
    workgroupBarrier();
    if thread == 0u {
        var sum = 0u;
        for (var rake = 0u; rake < SCAN_THREADS / RAKE; rake++) {
            let before = sum;
            sum += scan_rakes[rake];
            scan_rakes[rake] = before;
        }
        scan_rakes[SCAN_THREADS / RAKE] = sum;
    }
    workgroupBarrier();
    let before = scan_rakes[thread / RAKE] + scan_shared[thread];
    let total = scan_rakes[SCAN_THREADS / RAKE];
    workgroupBarrier();
    return Scanned(before, total);
}
