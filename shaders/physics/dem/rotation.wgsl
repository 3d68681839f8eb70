// Rotation: angular velocities (rad/s), angles (rad) and torques (N·m). About z, counter-clockwise, in 2D.
#import common/vector

#if two_dimensional
alias Rotation = f32;

fn unpack_rotation(stored: Packed) -> Rotation {
    return stored.z;
}

fn pack_rotation(rotation: Rotation, number: f32) -> Packed {
    return vec4f(0.0, 0.0, rotation, number);
}

// Velocity of a point that turns, at `arm` from its center.
fn velocity_at(rotation: Rotation, arm: Vector) -> Vector {
    return rotation * vec2f(-arm.y, arm.x);
}

// Torque of a force that acts at `arm`.
fn torque_at(arm: Vector, force: Vector) -> Rotation {
    return arm.x * force.y - arm.y * force.x;
}

// The part of a rotation that rolls over a surface; the rest would twist.
fn rolling_part(rotation: Rotation, normal: Vector) -> Rotation {
    return rotation;
}
#else
alias Rotation = vec3f;

fn unpack_rotation(stored: Packed) -> Rotation {
    return stored.xyz;
}

fn pack_rotation(rotation: Rotation, number: f32) -> Packed {
    return vec4f(rotation, number);
}

// Velocity of a point that turns, at `arm` from its center.
fn velocity_at(rotation: Rotation, arm: Vector) -> Vector {
    return cross(rotation, arm);
}

// Torque of a force that acts at `arm`.
fn torque_at(arm: Vector, force: Vector) -> Rotation {
    return cross(arm, force);
}

// The part of a rotation that rolls over a surface; the rest twists.
fn rolling_part(rotation: Rotation, normal: Vector) -> Rotation {
    return rotation - dot(rotation, normal) * normal;
}
#end
