// Behind everything: a gradient, and the floor with shadows, fading into it.

#import render/picture
#if has_floor
#import render/floor
#import render/ray
#end
#if shadows
#import render/shadow
#end
#if water
#import render/water/light
#end

// Linear color at a place of the scene's rectangle, in pixels, multiplied by its alpha.
fn backdrop(pixel: vec2f) -> vec4f {
#if transparent
    var color = vec4f(0.0);
#else
    let height = 1.0 - pixel.y / f32(picture.rectangle.w);
    var color = vec4f(mix(picture.backdrop_low.rgb, picture.backdrop_high.rgb, smoothstep(0.0, 1.0, height)), 1.0);
#end
#if has_floor
    let ray = ray_through(pixel);
    let floor = floor_seen(ray.start, ray.direction);
    if floor.fade > 0.0 {
        var shade = vec3f(0.0);
#if shadows
        shade = vec3f(1.0 - soft_sunlight(floor.point));
#if water
        shade = 1.0 - (1.0 - shade) * light_through_water(floor.point);
#end
#end
#if transparent
        color.a = floor.fade * picture.floor_color.w * dot(shade, vec3f(0.2126, 0.7152, 0.0722));
#else
        color = mix(color, vec4f(picture.floor_color.rgb * (1.0 - picture.floor_color.w * shade), 1.0), floor.fade);
#end
    }
#end
    return color;
}
