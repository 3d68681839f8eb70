// Watches how far particles move from where they were listed.
#import common/vector
#import cells/grid
#import cells/images
#import physics/guard

var<storage, read> listed_position: array<Packed>;

// Two particles that come nearer by the skin together have moved by half of it each.
fn watch_list(i: u32, moved: Vector) {
    let moved_by = nearest_image(moved - unpack(listed_position[i]));
    if dot(moved_by, moved_by) > grid.list_move {
        atomicStore(&guard.far, 1u);
    }
}
