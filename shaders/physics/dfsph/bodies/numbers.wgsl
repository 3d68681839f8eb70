// Particles of rigid bodies are the first of the boundary particles, by id.
#import common/parameters

// Below MEMBERS for those of bodies.
fn member_number(id: u32) -> u32 {
    return id - parameters.first_boundary;
}

// The number of the list of such a particle, which stands at `slot`.
fn list_of_member(number: u32, slot: u32) -> u32 {
#if separated
    return parameters.free_count + number;
#else
    return slot;
#end
}
