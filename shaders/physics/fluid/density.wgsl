// Density and pressure of each particle of the fluid.
#flag writes_state
#import common/thread
#import physics/time_step
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#if planes
#import physics/fluid/planes
#end
#if gradient_correction
#import physics/fluid/matrix
var<storage, read_write> correction: array<Matrix>;
#end
#if continuity
var<storage, read> excess: array<f32>; // of the step before
#end

#if mirrored_walls
// A wall mirrors what comes near: the velocity goes on along a straight line beyond it.
const MIRRORED: f32 = 2.0;
#else
const MIRRORED: f32 = 1.0;
#end
#if clamped_pressure
// A particle has left the fluid where the divergence of positions (Lee 2008), which is DIMENSIONS inside, is below this:
// one neighbor or two at most.
const SEVERED: f32 = 0.15 * f32(DIMENSIONS);
#end
// Below this determinant a particle has too few neighbors for its gradients to be corrected.
const FEW_NEIGHBORS: f32 = 0.3;

@compute @workgroup_size(GROUP_SIZE)
fn find_density(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || is_wall(i) {
        return;
    }
    let x = unpack(position[i]);
    let own = material_of(i);
#if continuity
    let v = unpack(velocity[i]);
    let before = excess[i];
    var divergence = 0.0;
#if clamped_pressure
    var surrounded = 0.0; // divergence of positions
#end
    var diffused = 0.0;
    // What density gains along gravity at rest, which must not diffuse (Fourtakas 2019): dρ/ρ₀ = (ρ/ρ₀)^(2−γ) g·dx/c².
    let at_rest = first(parameters.gravity) * first(fluid.closed)
        * (fluid.inverse_sound_squared * (1.0 + (2.0 - f32(GAMMA)) * before));
#else
    var sum = kernel(0.0);
#end
#if gradient_correction
    var moment = Matrix();
    var slopes = Matrix();
#end
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = toward(x, j);
            if within(s, fluid.support) && j != i {
                let r = length(s);
#if continuity
                let other = excess[j];
                let weight = volume_at(other) * kernel_slope(r);
#if clamped_pressure
                surrounded -= weight * dot(s, s);
#end
                let relative = unpack(velocity[j]) - v;
#if gradient_correction
                moment -= weight * outer(s, s);
                slopes -= (weight * select(1.0, MIRRORED, is_wall(j))) * outer(relative, s);
#else
                divergence -= (weight * select(1.0, MIRRORED, is_wall(j))) * dot(relative, s);
#end
#if density_diffusion
                var mixes = !is_wall(j);
#if several_materials
                mixes = mixes && material[j] == material[i];
#end
                diffused -= select(0.0, weight * (other - before - dot(at_rest, s)), mixes);
#end
#else
                sum += kernel(r);
#if gradient_correction
                moment -= fluid.volume * kernel_slope(r) * outer(s, s);
#end
#end
            }
        }
    }
#if planes
    let cells = cells_beyond(x);
    for (var number = 0u; number < cells; number++) {
        let cell = beyond(x, number);
        let r = length(cell.way);
#if continuity
        let weight = cell.share * volume_at(before) * kernel_slope(r);
        let relative = cell.velocity - v;
#if clamped_pressure
        surrounded -= weight * r * r;
#end
#if gradient_correction
        moment -= weight * outer(cell.way, cell.way);
        slopes -= (MIRRORED * weight) * outer(relative, cell.way);
#else
        divergence -= (MIRRORED * weight) * dot(relative, cell.way);
#end
#else
        sum += cell.share * kernel(r);
#if gradient_correction
        moment -= cell.share * fluid.volume * kernel_slope(r) * outer(cell.way, cell.way);
#end
#end
    }
#end
#if gradient_correction
    var exact = unit();
    if determinant(moment) > FEW_NEIGHBORS {
        exact = inverse(moment);
    }
    correction[i] = exact;
#if continuity
    divergence = trace(slopes * exact);
#end
#end
#if continuity
    var e = before + time_step() * (fluid.diffusion * diffused - (1.0 + before) * divergence);
#if clamped_pressure
    // Torn fluid keeps close to rest density: it would have to be pressed together again before a wall could hold it.
    e = max(e, fluid.lowest_excess);
    // What has left the fluid is under the air's pressure: with the one that it left at, drops would hover on each
    // other as a gas does.
    e = select(e, min(e, 0.0), surrounded < SEVERED);
#end
#else
    let e = fluid.volume * sum - 1.0;
#end
    var p = pressure_at(own.stiffness, e);
#if clamped_pressure
    p = max(p, 0.0);
#end
    fluid_state[i] = vec2f(e, p);
}
