// Linear spring and dashpot, across and along the contact (Cundall and Strack 1979).
#import physics/dem/pairing

// `depth` is the mean overlap while the dashpot acts, m.
fn respond(pairing: Pairing, overlap: f32, depth: f32) -> Response {
    return Response(
        pairing.stiffness * overlap,
        pairing.stiffness,
        pairing.damping,
        pairing.shear_stiffness,
        pairing.shear_damping,
    );
}

#if sizes
// The same for a contact of this share of effective mass: restitution stays, and the duration too where springs follow masses.
fn of_size(pairing: Pairing, mass: f32, radius: f32) -> Pairing {
    var own = pairing;
#if springs_by_mass
    let dashpot = mass;
    own.stiffness *= mass;
    own.shear_stiffness *= mass;
#else
    let dashpot = sqrt(mass);
#end
    own.damping *= dashpot;
    own.shear_damping *= dashpot;
    return own;
}
#end
