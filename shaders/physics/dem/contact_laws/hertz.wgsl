// Elastic spheres: F = 4/3 E* √R* δ^(3/2) (Hertz 1882), k_t = 8 G* √(R* δ) (Mindlin 1949), with the damping that gives one
// restitution at all speeds (Tsuji 1992; Antypov and Elliott 2011).
#import physics/dem/pairing

// `depth` is the mean overlap while the dashpot acts, m.
fn respond(pairing: Pairing, overlap: f32, depth: f32) -> Response {
    let root = sqrt(overlap);
    let fourth_root = sqrt(sqrt(depth));
    return Response(
        pairing.stiffness * overlap * root,
        1.5 * pairing.stiffness * root,
        pairing.damping * fourth_root,
        pairing.shear_stiffness * root,
        pairing.shear_damping * fourth_root,
    );
}

#if sizes
// The same for a contact of these shares of effective mass and radius.
fn of_size(pairing: Pairing, mass: f32, radius: f32) -> Pairing {
    var own = pairing;
    let spring = sqrt(radius);
    let dashpot = sqrt(spring * mass);
    own.stiffness *= spring;
    own.shear_stiffness *= spring;
    own.damping *= dashpot;
    own.shear_damping *= dashpot;
    return own;
}
#end
