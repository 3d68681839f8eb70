// What the loops keep of each particle.

struct Own {
    deviation: f32, // ρ/ρ₀ − 1
    impulse: f32, // impulse of a loop so far, Pa·s
    response: f32, // impulse over the rate at which it thins the fluid out, Pa·s²
    previous: f32, // impulse of the iteration before, Pa·s
}

var<storage, read_write> own: array<Own>;

// An iteration's step against `rate`, 1/s, which is left: Jacobi's, relaxed, with the momentum of the step before (Nesterov
// 1983), which takes a third of the iterations. Returns the impulse that has to act.
fn iterate(i: u32, rate: f32) -> f32 {
    let mine = own[i];
    let next = max(mine.impulse + dfsph.relaxation * rate * mine.response, 0.0);
    let ahead = next + dfsph.momentum * (next - mine.previous);
    own[i].previous = next;
    own[i].impulse = ahead;
    return ahead - mine.impulse;
}
