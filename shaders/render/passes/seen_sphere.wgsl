// A particle drawn as a sphere, where the middle of a pixel sees it.

#import render/state
#import render/drawn
#import render/passes/surface

fn seen_particle(i: u32, pixel: vec2u) -> Surface {
    return on_sphere(to_3d(unpack(position[i])), drawn_radius(i), pixel);
}
