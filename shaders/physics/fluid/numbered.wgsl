// The particles that passes over fluid and boundary go over, by number. Where lists know which boundary particles are in reach
// of fluid, the others have no number.
#if boundary_in_reach
#import storage/lists/reached
#else
#import common/parameters

fn numbered_particle(number: u32) -> u32 {
    return number;
}
#end
