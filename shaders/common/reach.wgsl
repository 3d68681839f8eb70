// The one predicate for "within the radius": strictly less, in f32.
#import common/vector

fn within(separation: Vector, radius: f32) -> bool {
    return dot(separation, separation) < radius * radius;
}
