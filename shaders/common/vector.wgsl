// Points and directions: two components in a 2D scene, three in a 3D scene. Metres, m/s, m/s².

#if two_dimensional
alias Vector = vec2f;
alias Packed = vec2f; // as stored
alias Coordinate = vec2i; // of a voxel

fn unpack(stored: Packed) -> Vector {
    return stored;
}

fn pack(v: Vector) -> Packed {
    return v;
}

// The two components of a uniform that has room for four.
fn first(v: vec4f) -> Vector {
    return v.xy;
}

fn to_3d(v: Vector) -> vec3f {
    return vec3f(v, 0.0);
}
#else
alias Vector = vec3f;
alias Packed = vec4f; // as stored; w is not used
alias Coordinate = vec3i; // of a voxel

fn unpack(stored: Packed) -> Vector {
    return stored.xyz;
}

fn pack(v: Vector) -> Packed {
    return vec4f(v, 0.0);
}

// The three components of a uniform that has room for four.
fn first(v: vec4f) -> Vector {
    return v.xyz;
}

fn to_3d(v: Vector) -> vec3f {
    return v;
}
#end
