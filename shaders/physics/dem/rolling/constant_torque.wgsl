// Resistance to rolling by a torque of constant size, against the rolling (type A of Ai et al. 2011). It does not turn a
// grain back: in one step it takes no more than the rolling there is.
#import physics/dem/rotation
#import physics/dem/pairing

// Torque on the grain. `rate` is how fast the other one rolls relative to it, `angle` how far it rolled, and stays as it is.
fn resist_rolling(
    pairing: Pairing,
    response: Response,
    push: f32,
    rate: Rotation,
    angle: ptr<function, Rotation>,
    dt: f32,
) -> Rotation {
    let speed = length(rate);
    if speed <= 0.0 || dt <= 0.0 {
        return Rotation();
    }
    return min(pairing.rolling_limit * push, pairing.rolling_inertia * speed / dt) * (rate / speed);
}
