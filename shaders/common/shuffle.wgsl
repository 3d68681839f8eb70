// The numbers below 2³² in an order without any order (lowbias32 of C. Wellons): each comes once.
fn shuffled(number: u32) -> u32 {
    var x = number;
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}
