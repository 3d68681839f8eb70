// Particle shifting beside a free surface: along it only, and not at all for what has left the fluid (Lind 2012; Sun 2017).

// Shares of a particle's neighborhood that are there: what counts as the surface, and as a drop, from wholly to not.
const SURFACE = vec2f(0.8, 0.95);
const DROP = vec2f(0.3, 0.4);

fn free_surface_shifting_end(own: Own, forces: ptr<function, Forces>) {
    let around = forces.surroundings;
    let crowd = forces.shifting.crowd;
    let normal = around.inside / max(length(around.inside), 1e-30);
    let through = (1.0 - ramp(SURFACE, around)) * dot(crowd, normal);
    forces.shifting.crowd = ramp(DROP, around) * (crowd - through * normal);
}
