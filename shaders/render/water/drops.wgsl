// Particles with few neighbors: small spheres, white where they are spray. Spray has soft rims: chance leaves samples out, so that
// what lies behind shows through.

#import render/water/sphere
#import render/lighting

@vertex
fn place_water_drop(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    var corner: Corner;
    corner.clip = NOWHERE;
    if is_drawn(i) && is_drop(i) {
        corner = sphere_corner(index, i, drop_radius(i));
    }
    return corner;
}

struct Surface {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn shade_water_drop(corner: Corner) -> Surface {
    let ray = hit(corner);
    if ray.enters >= ray.leaves {
        discard;
    }
    let point = corner.point + ray.enters * ray.direction;
    let normal = (point - corner.sphere.xyz) / corner.sphere.w;
    if water.spray > 0.0 {
        let sample = vec2u(corner.clip.xy);
        let facing = -dot(normal, ray.direction);
        if facing * facing < random_share(sample.x + 4099u * sample.y + bitcast<u32>(corner.sphere.x)) {
            discard;
        }
    }
    let albedo = mix(water.drop.rgb, vec3f(0.93), water.spray);
    let clip = picture.view_projection * vec4f(point, 1.0);
    var surface: Surface;
    surface.depth = clip.z / clip.w;
    surface.color = vec4f(shade(albedo, normal, -ray.direction, point, 1.0, corner.clip.xy), 1.0);
    return surface;
}
