// What slows fluid down beside fluid and walls of another velocity: viscosity (Morris et al. 1997, Eq. 22) and artificial
// viscosity (Monaghan 1992).

// Acceleration by particle j, m/s²; s leads to it, and slope × s is the kernel's gradient times a particle's volume.
fn drag_by(j: u32, v: Vector, s: Vector, slope: f32) -> Vector {
    let apart = unpack(velocity[j]) - v;
#if slips
    let sticks = !is_boundary(j);
#else
    let sticks = true;
#end
    var drag = Vector(0.0);
#if viscosity
    drag -= select(0.0, 2.0 * fluid.viscosity / fluid.density * slope, sticks) * apart;
#end
#if artificial_viscosity
    let approach = min(dot(apart, s), 0.0);
    let damping = select(0.0, fluid.artificial_viscosity * slope, sticks);
    drag -= (damping * approach / (dot(s, s) + fluid.smallest_square)) * s;
#end
    return drag;
}
