// Resistance to rolling by a spring that gives way at a limit, and a dashpot as long as it holds (type C of Ai et al. 2011;
// the stiffness of Iwashita and Oda 1998: 2.25 k_n μ_r² R*²).
#import physics/dem/rotation
#import physics/dem/pairing

// Torque on the grain. `rate` is how fast the other one rolls relative to it. `angle` is how far the spring is turned: half
// a step ago before, half a step later after.
fn resist_rolling(
    pairing: Pairing,
    response: Response,
    push: f32,
    rate: Rotation,
    angle: ptr<function, Rotation>,
    dt: f32,
) -> Rotation {
    let stiffness = pairing.rolling_stiffness * response.stiffness;
    let limit = pairing.rolling_limit * push;
    let turned = *angle + 0.5 * dt * rate;
    let torque = stiffness * turned;
    let size = length(torque);
    if size > limit {
        *angle = turned * (limit / size);
        return torque * (limit / size);
    }
    *angle = turned + 0.5 * dt * rate;
    return torque + pairing.rolling_damping * sqrt(stiffness) * rate;
}
