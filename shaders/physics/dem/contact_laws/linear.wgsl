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
