// What rounding has left out of a position, beside it: eight bits of each coordinate. Without them grains at rest would be
// pushed to and fro by the force of an overlap that is as large as the last bit of a position.
#import common/vector

// What a step of -128 to 127 stands for, m: at most 128 make half of the last bit of the largest coordinate.
fn rest_unit(x: Vector) -> f32 {
    let far = abs(to_3d(x));
    return max(far.x, max(far.y, far.z)) * (1.0 / 2147483648.0);
}

// As a whole number below 2^24, which f32 holds; 0 is nothing too.
fn number_of_rest(x: Vector, rest: Vector) -> f32 {
    let unit = max(rest_unit(x), 1e-30);
    let steps = clamp(round(to_3d(rest) / unit), vec3f(-127.0), vec3f(127.0)) + 128.0;
    return steps.x + 256.0 * steps.y + 65536.0 * steps.z;
}

fn rest_of(position: Packed) -> Vector {
    let number = u32(number_of(position));
    if number == 0u {
        return Vector(0.0);
    }
    let steps = vec3f(vec3u(number, number >> 8u, number >> 16u) & vec3u(255u)) - 128.0;
    return first(vec4f(steps * rest_unit(unpack(position)), 0.0));
}
