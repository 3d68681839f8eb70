// Prefix sum of a digit's counts: where each run's pairs with that digit begin.
#import storage/scan
#import storage/radix/runs

var<storage, read_write> digit_count: array<u32>;

fn scan_items() -> u32 {
    return DIGITS * runs();
}

fn scan_value(item: u32) -> u32 {
    return digit_count[item];
}

fn scan_result(item: u32, before: u32) {
    digit_count[item] = before;
}
