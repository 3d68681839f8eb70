// How fast the device copies: every thread moves 16 bytes.
#import common/thread

var<storage, read> copied_from: array<vec4f>;
var<storage, read_write> copied_to: array<vec4f>;

@compute @workgroup_size(GROUP_SIZE)
fn copy(thread: Thread) {
    let i = item_index(thread);
    if i < arrayLength(&copied_to) {
        copied_to[i] = copied_from[i];
    }
}
