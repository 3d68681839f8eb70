// Watches how far particles come from where their lists expect them.
#import common/vector
#import cells/grid
#import cells/images
#import physics/guard
#import storage/lists/listed
#if straight_paths
#import physics/time_step
#end

var<storage, read> listed: array<Listed>;

// Two particles that come nearer by the skin together than was expected have each done so by half of it.
fn watch_list(i: u32, moved: Vector) {
    let before = listed[i];
    let moved_by = nearest_image(moved - unpack(before.place));
#if straight_paths
    let strayed_by = moved_by - (guard.listed_for + time_step()) * unpack(before.motion);
    if dot(strayed_by, strayed_by) > grid.list_move || dot(moved_by, moved_by) > grid.list_way {
#else
    if dot(moved_by, moved_by) > grid.list_move {
#end
        atomicStore(&guard.far, 1u);
    }
}
