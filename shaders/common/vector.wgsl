// Points and directions: two components in a 2D scene, three in a 3D scene. Metres, m/s, m/s².

// As stored: one load brings a vector and, in w, a number that a solver keeps beside it.
alias Packed = vec4f;

fn pack(v: Vector) -> Packed {
    return pack_with(v, 0.0);
}

// What `pack_with` put beside a vector.
fn number_of(stored: Packed) -> f32 {
    return stored.w;
}

#if two_dimensional
alias Vector = vec2f;
alias Coordinate = vec2i; // of a voxel

fn unpack(stored: Packed) -> Vector {
    return stored.xy;
}

// With a number of the particle beside it.
fn pack_with(v: Vector, number: f32) -> Packed {
    return vec4f(v, 0.0, number);
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
alias Coordinate = vec3i; // of a voxel

fn unpack(stored: Packed) -> Vector {
    return stored.xyz;
}

// With a number of the particle beside it.
fn pack_with(v: Vector, number: f32) -> Packed {
    return vec4f(v, number);
}

// The three components of a uniform that has room for four.
fn first(v: vec4f) -> Vector {
    return v.xyz;
}

fn to_3d(v: Vector) -> vec3f {
    return v;
}
#end
