// How fast the device computes: every thread multiplies and adds 32 numbers over and over.
#import common/thread

var<uniform> turns: u32;
var<storage, read_write> computed: array<vec4f>;

@compute @workgroup_size(GROUP_SIZE)
fn multiply_and_add(thread: Thread) {
    let i = item_index(thread);
    // Chains that do not wait for each other and stay finite.
    let factor = vec4f(0.999);
    let more = vec4f(0.001);
    var a = vec4f(f32(i));
    var b = a + 1.0;
    var c = a + 2.0;
    var d = a + 3.0;
    var e = a + 4.0;
    var f = a + 5.0;
    var g = a + 6.0;
    var h = a + 7.0;
    for (var turn = 0u; turn < turns; turn++) {
        a = fma(a, factor, more);
        b = fma(b, factor, more);
        c = fma(c, factor, more);
        d = fma(d, factor, more);
        e = fma(e, factor, more);
        f = fma(f, factor, more);
        g = fma(g, factor, more);
        h = fma(h, factor, more);
    }
    if i < arrayLength(&computed) {
        computed[i] = a + b + c + d + e + f + g + h;
    }
}
