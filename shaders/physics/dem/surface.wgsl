// Surfaces of grains, that contact forces are divided by.
#import physics/measure
#if rotation
#import physics/dem/friction
#else
#import physics/dem/law
#end

// Of the grain that has these contacts, m² (its rim times one metre in 2D).
fn surface_of(sum: ContactSum) -> f32 {
#if sizes
    return measure.surface * mass_share(sum.size) / sum.size;
#else
    return measure.surface;
#end
}
