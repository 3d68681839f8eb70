// Whether lists still serve.

struct ListState {
    longest: atomic<u32>, // list of the last search, in full
    searches: u32, // steps that searched, since the run began
    first_step: u32, // of the clock when the run began or went on: frames end at multiples of their steps from there
    last_step: u32, // of the clock when steps end and the host has its turn
    horizon: f32, // how long lists that expect straight paths look ahead, s; 0 for what the grid says
}

var<storage, read_write> list_state: ListState;

#if straight_paths
#import cells/grid

fn list_horizon() -> f32 {
    return select(list_state.horizon, grid.list_horizon, list_state.horizon == 0.0);
}
#end
