// What a pressure solve keeps of each particle.

struct Own {
    source: f32, // rate of compression that pressure has to undo, 1/s
    response: f32, // impulse over the rate at which it thins the fluid out by itself, Pa·s²
    previous: f32, // impulse of the sweep before, Pa·s
}

var<storage, read_write> own: array<Own>;
