// What is known of densities before a step's are found.
#if continuity
#import fields/density_deviation

fn deviation_before(i: u32) -> f32 {
    return density_deviation_of(i);
}
#else
fn deviation_before(i: u32) -> f32 {
    return 0.0;
}
#end
