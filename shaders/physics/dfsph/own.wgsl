// What the loops keep of each particle.
#import common/vector

struct Own {
    deviation: f32, // (ρ/ρ₀ − 1) / `lattice_gradient`: what `compression_rate` has added up to
    source: f32, // rate of compression that pressure has to undo, 1/s; before, the share of density that a surface lacks
    closing: f32, // rate at which a gap of the fluid may close, 1/s
    impulse: f32, // the pressure's remainder, then that of the loop of density so far, Pa·s
    previous: f32, // impulse of the sweep or iteration before, Pa·s
    most: f32, // impulse of pressure that is allowed, Pa·s; before, the sum of gradients, walls mirrored, 1/m
    response: f32, // impulse over the rate at which it thins the fluid out by itself, in the compact equation, Pa·s²
    exact_response: f32, // the same of the exact equation
#if drag
    drag: Packed, // acceleration by viscosities, m/s²
#end
}

var<storage, read_write> own: array<Own>;
