// Forces on a particle of the fluid. Knows nothing of the grid behind `<candidates>`.
#import physics/time_step
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#if matrices
#import physics/fluid/matrix
#end
#import physics/fluid/viscous
#if planes
#import physics/fluid/planes
#end
#if free_surface_shifting
#import physics/fluid/shift
#end
#if stress_form
var<storage, read> stress: array<Matrix>;
#end
#if surface_tension
var<storage, read> surface_normal: array<Packed>;
#end
#if gradient_correction
var<storage, read> correction: array<Matrix>;
#end

struct Forces {
    acceleration: Vector, // m/s²
#if shifting
    shift: Vector, // way to where particles are sparser, m
    velocity_slope: Matrix, // along which the velocity changes on that way, 1/s
    excess_slope: Vector, // 1/m
#end
}

fn forces_on(i: u32) -> Forces {
    let x = unpack(position[i]);
    let v = unpack(velocity[i]);
    let own = material_of(i);
    let state = fluid_state[i];
    let density = own.density * (1.0 + state.x);
    var push = Vector(0.0); // of pressure, N/m³
    var drag = Vector(0.0); // of viscosity, N/m³
#if velocity_slopes
    var velocity_slope = Matrix();
#end
#if laplacian_correction
    var offset = Vector(0.0); // where the weights of viscous forces are not balanced
#end
#if sliding_walls
    var inwards = Vector(0.0); // into the walls around; as long as they have area over volume, 1/m
    var against = 0.0; // how much of them is near, 1/m²
    var wall_velocity = Vector(0.0);
    var damping = Matrix();
#end
#if shifting
    var crowd = Vector(0.0);
#if free_surface_shifting
    var inside = Vector(0.0); // away from the surface
    var surrounded = 0.0; // divergence of positions: DIMENSIONS inside (Lee 2008)
#end
    var excess_slope = Vector(0.0);
#end
#if surface_tension
    let normal = unpack(surface_normal[i]);
    let direction = normal / max(length(normal), 1e-30);
    var turned = 0.0; // of the normals around, 1/m
    var seen = 0.0;
#end
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = toward(x, j);
#if of_one_body
            if within(s, fluid.support) && is_sensed(j) {
#else
            if within(s, fluid.support) && j != i {
#end
                let r = length(s);
                let other = fluid_state[j];
                let weight = volume_at(other.x) * kernel_slope(r); // the gradient of W is −s times the slope
#if difference_pressure
                push += (weight * (other.y - state.y)) * s;
#else
#if monaghan_pressure
                let ratio = material_of(j).density * (1.0 + other.x) / density;
                push += (weight * (state.y * ratio + other.y / ratio)) * s;
#else
#if controlled_pressure
                push += (weight * (other.y + abs(state.y))) * s;
#else
                push += (weight * (other.y + state.y)) * s;
#end
#end
#end
#if laplacian_form
#if slips
                let shear = select(own.viscosity + material_of(j).viscosity, 0.0, is_wall(j));
#else
                let shear = own.viscosity + material_of(j).viscosity;
#end
#if muller_kernels
                drag += (0.5 * shear * volume_at(other.x) * kernel_laplacian(r)) * (viscous(j) - v);
#else
                drag -= (shear * weight) * (viscous(j) - v);
#if laplacian_correction
                offset -= (shear * weight) * s;
#end
#end
#end
#if stress_form
                // A wall's stress is taken to be that of the fluid beside it.
                let mine = stress[i] * s;
#if gradient_correction
                drag -= weight * select(stress[j] * s - mine, Vector(0.0), is_wall(j));
#else
                drag -= weight * (mine + select(stress[j] * s, mine, is_wall(j)));
#end
#end
#if surface_tension
                let beside = unpack(surface_normal[j]);
                let steepness = length(beside);
#if several_materials
                let on_surface = steepness > 0.0 && material[j] == material[i];
#else
                let on_surface = steepness > 0.0;
#end
                let part = select(0.0, weight, on_surface);
                let along = s - dot(s, direction) * direction;
                turned -= part * dot(beside / max(steepness, 1e-30) - direction, along);
                seen -= part * dot(along, along);
#end
#if sliding_walls
                let wall = select(0.0, -weight, is_wall(j));
                inwards += wall * s;
                against += wall;
                wall_velocity += wall * unpack(velocity[j]);
#end
#if artificial_viscosity
                var approach = min(dot(unpack(velocity[j]) - v, s), 0.0);
                let square = dot(s, s) + fluid.smallest_square;
#if sliding_walls
                approach = select(approach, 0.0, is_wall(j));
                damping += (wall / square) * outer(s, s);
#end
                drag -= (weight * density * fluid.artificial_viscosity * approach / square) * s;
#end
#if velocity_slopes
#if slips
                velocity_slope -= select(weight, 0.0, is_wall(j)) * outer(viscous(j) - v, s);
#else
                velocity_slope -= weight * outer(viscous(j) - v, s);
#end
#end
#if shifting
                // More where particles come close, so that they do not pair (Monaghan 2000).
                let near = kernel(r) / fluid.kernel_at_spacing;
                crowd -= (weight * (1.0 + 0.2 * (near * near) * (near * near))) * s;
                excess_slope -= (weight * (other.x - state.x)) * s;
#if free_surface_shifting
                inside -= weight * s;
                surrounded -= weight * dot(s, s);
#end
#end
            }
        }
    }
#if planes
    let cells = cells_beyond(x);
    for (var number = 0u; number < cells; number++) {
#if of_one_body
        var cell = beyond(x, number);
        cell.share *= select(0.0, 1.0, is_sensed_side(x + cell.way));
#else
        let cell = beyond(x, number);
#end
        let s = cell.way;
        let r = length(s);
        let weight = cell.share * volume_at(state.x) * kernel_slope(r);
        var pressure = state.y + density * dot(first(parameters.gravity) * first(fluid.closed), s);
#if clamped_pressure
        pressure = max(pressure, 0.0);
#end
#if difference_pressure
        push += (weight * (pressure - state.y)) * s;
#else
#if controlled_pressure
        push += (weight * (pressure + abs(state.y))) * s;
#else
        push += (weight * (pressure + state.y)) * s;
#end
#end
        let apart = cell.velocity - v;
#if !slips
#if laplacian_form
#if muller_kernels
        drag += (cell.share * own.viscosity * volume_at(state.x) * kernel_laplacian(r) * cell.stretch) * apart;
#else
        drag -= (2.0 * own.viscosity * weight * cell.stretch) * apart;
#if laplacian_correction
        offset -= (2.0 * own.viscosity * weight) * s;
#end
#end
#end
#end
#if stress_form
#if !gradient_correction
        drag -= (2.0 * weight) * (stress[i] * s);
#end
#end
#if sliding_walls
        inwards -= weight * s;
        against -= weight;
        wall_velocity -= weight * cell.velocity;
#end
#if artificial_viscosity
        let square = dot(s, s) + fluid.smallest_square;
#if sliding_walls
        damping -= (weight / square) * outer(s, s);
#else
        let approach = min(dot(apart, s), 0.0);
        drag -= (weight * density * fluid.artificial_viscosity * approach / square) * s;
#end
#end
#if shifting
        let near = kernel(r) / fluid.kernel_at_spacing;
        crowd -= (weight * (1.0 + 0.2 * (near * near) * (near * near))) * s;
#if free_surface_shifting
        inside -= weight * s;
        surrounded -= weight * dot(s, s);
#end
#end
#if velocity_slopes
#if !slips
        velocity_slope -= (weight * cell.stretch) * outer(apart, s);
#end
#end
    }
#end
#if gradient_correction
    let exact = correction[i];
#if difference_pressure
    push = exact * push;
#end
#if stress_form
    drag = exact * drag;
#end
#if velocity_slopes
    velocity_slope = velocity_slope * exact;
#end
#if laplacian_correction
    // The sum is exact for lattices; else it holds a part of the slope, and its weights do not add up (Schwaiger 2008).
    drag = (trace(exact) / f32(DIMENSIONS)) * (drag - velocity_slope * offset);
#end
#if shifting
    excess_slope = exact * excess_slope;
#end
#end
#if sliding_walls
    let area = length(inwards);
    inwards = inwards / max(area, 1e-30);
    let past = wall_velocity / max(against, 1e-30) - v; // how the walls go past
    let nearing = dot(past, inwards);
#if artificial_viscosity
    // Walls that slip damp what comes nearer and leave alone what goes along them.
    drag += (density * fluid.artificial_viscosity * min(nearing, 0.0) * dot(inwards, damping * inwards)) * inwards;
#end
#if wall_friction
    // A stress of ½ c ρ v² on the area (Darcy and Weisbach), half of which the kernels of the particles beside it see.
    let along = past - nearing * inwards;
    drag += (density * fluid.wall_friction * area * length(along)) * along;
#end
#end
    var forces = Forces();
#if surface_tension
    // Continuum surface force (Brackbill 1992). The curvature is how much normals turn along the surface, over what is
    // seen of it (after Adami 2010, who counts the way across it too), as far as particles resolve it. Half of the
    // color's slope lies outside, so what lies inside counts twice.
    let sharpest = 0.5 * f32(DIMENSIONS - 1u) / fluid.spacing;
    let curvature = clamp(-f32(DIMENSIONS - 1u) * turned / max(seen, 1e-30), -sharpest, sharpest);
    push += (2.0 * own.surface_tension * curvature) * normal;
#end
#if of_one_body
    forces.acceleration = (push + drag) / density;
#else
    forces.acceleration = first(parameters.gravity) + (push + drag) / density;
#end
#if shifting
#if free_surface_shifting
    crowd = along_surface(crowd, inside, surrounded);
#end
    let wanted = -(time_step() * fluid.shifting) * crowd;
    forces.shift = wanted * min(1.0, fluid.shift_limit / max(length(wanted), 1e-30));
    forces.velocity_slope = velocity_slope;
    forces.excess_slope = excess_slope;
#end
    return forces;
}
