// Prefix sum in three passes: sums of blocks, prefix sum of those, blocks again. No pass waits for another workgroup:
// WebGPU promises no forward progress between workgroups.
//
// The file that imports this one says what is summed: `scan_items()`, `scan_value(item)`, and
// `scan_result(item, before)`, which keeps the sum over all items before this one.
#import common/thread
#import common/workgroup_scan

const SCAN_BLOCK: u32 = SCAN_THREADS * SCAN_ITEMS;

var<storage, read_write> block_sum: array<u32>;

@compute @workgroup_size(SCAN_THREADS)
fn sum_blocks(thread: Thread) {
    let block = group_index(thread);
    let items = scan_items();
    if block * SCAN_BLOCK >= items {
        return;
    }
    let begin = block * SCAN_BLOCK + thread.local_index * SCAN_ITEMS;
    var sum = 0u;
    for (var item = begin; item < min(begin + SCAN_ITEMS, items); item++) {
        sum += scan_value(item);
    }
    let scanned = workgroup_scan(thread.local_index, sum);
    if thread.local_index == 0u {
        block_sum[block] = scanned.total;
    }
}

// One workgroup.
@compute @workgroup_size(SCAN_THREADS)
fn scan_blocks(@builtin(local_invocation_index) thread: u32) {
    let blocks = (scan_items() + SCAN_BLOCK - 1u) / SCAN_BLOCK;
    var before = 0u;
    for (var base = 0u; base < blocks; base += SCAN_THREADS) {
        let block = base + thread;
        var sum = 0u;
        if block < blocks {
            sum = block_sum[block];
        }
        let scanned = workgroup_scan(thread, sum);
        if block < blocks {
            block_sum[block] = before + scanned.before;
        }
        before += scanned.total;
    }
}

@compute @workgroup_size(SCAN_THREADS)
fn finish_scan(thread: Thread) {
    let block = group_index(thread);
    let items = scan_items();
    if block * SCAN_BLOCK >= items {
        return;
    }
    let begin = block * SCAN_BLOCK + thread.local_index * SCAN_ITEMS;
    let end = min(begin + SCAN_ITEMS, items);
    var sum = 0u;
    for (var item = begin; item < end; item++) {
        sum += scan_value(item);
    }
    var before = block_sum[block] + workgroup_scan(thread.local_index, sum).before;
    for (var item = begin; item < end; item++) {
        let value = scan_value(item);
        scan_result(item, before);
        before += value;
    }
}
