// Extra images for compositing: what the middle of each pixel sees, as numbers.

#import common/thread
#import render/passes/seen

struct Passes {
    next_view_projection: mat4x4f, // in the next frame
    frame_s: f32, // from this frame to the next
    nothing: f32, // depth where nothing is
    reserved_a: f32,
    reserved_b: f32,
}

var<storage, read> passes: Passes;
#if has_obstacles
var<storage, read> collider_motion: array<vec4f>; // velocity of each, m/s
#end
var<storage, read_write> pass_depth: array<f32>;
var<storage, read_write> pass_normal: array<vec2u>; // half floats
var<storage, read_write> pass_id: array<u32>;
var<storage, read_write> pass_velocity: array<f32>; // three per pixel
var<storage, read_write> pass_motion: array<vec2f>; // pixels to the right and up

fn pixels() -> u32 {
    return picture.rectangle.z * picture.rectangle.w;
}

fn pixel_of(item: u32) -> vec2u {
    return vec2u(item % picture.rectangle.z, item / picture.rectangle.z);
}

fn velocity_of(mark: u32) -> vec3f {
#if has_obstacles
    if (mark & OBSTACLE) != 0u {
        return collider_motion[obstacle_of(mark)].xyz;
    }
#end
    if mark > 0u {
        return to_3d(unpack(velocity[mark - 1u]));
    }
    return vec3f(0.0);
}

@compute @workgroup_size(GROUP_SIZE)
fn write_depth(thread: Thread) {
    let item = item_index(thread);
    if item < pixels() {
        let pixel = pixel_of(item);
        let seen = seen_at(pixel, mark_at(pixel));
        let depth = dot(seen.surface.point - picture.eye.xyz, picture.forward.xyz);
        pass_depth[item] = select(passes.nothing, depth, seen.is_something);
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn write_normal(thread: Thread) {
    let item = item_index(thread);
    if item < pixels() {
        let pixel = pixel_of(item);
        let normal = seen_at(pixel, mark_at(pixel)).surface.normal;
        pass_normal[item] = vec2u(pack2x16float(normal.xy), pack2x16float(vec2f(normal.z, 0.0)));
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn write_id(thread: Thread) {
    let item = item_index(thread);
    if item < pixels() {
        let mark = mark_at(pixel_of(item));
        var number = 0u;
        if (mark & OBSTACLE) != 0u {
            number = 0xffffffffu - obstacle_of(mark);
        } else if mark > 0u {
            number = id[mark - 1u] + 1u;
        }
        pass_id[item] = number;
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn write_velocity(thread: Thread) {
    let item = item_index(thread);
    if item < pixels() {
        let moves = velocity_of(mark_at(pixel_of(item)));
        pass_velocity[3u * item] = moves.x;
        pass_velocity[3u * item + 1u] = moves.y;
        pass_velocity[3u * item + 2u] = moves.z;
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn write_motion(thread: Thread) {
    let item = item_index(thread);
    if item < pixels() {
        let pixel = pixel_of(item);
        let mark = mark_at(pixel);
        let seen = seen_at(pixel, mark);
        let then = passes.next_view_projection * vec4f(seen.surface.point + velocity_of(mark) * passes.frame_s, 1.0);
        var motion = vec2f(0.0);
        if seen.is_something && then.w > 0.0 {
            let place = (vec2f(0.5) + vec2f(0.5, -0.5) * then.xy / then.w) * vec2f(picture.rectangle.zw);
            let moved = place - (vec2f(pixel) + 0.5);
            motion = vec2f(moved.x, -moved.y);
        }
        pass_motion[item] = motion;
    }
}
