// Whether lists still serve.

struct ListState {
    longest: atomic<u32>, // list of the last search, in full
    searches: u32, // steps that searched, since the run began
    first_step: u32, // of the clock when the run began or went on: frames end at multiples of their steps from there
    last_step: u32, // of the clock when steps end and the host has its turn
}

var<storage, read_write> list_state: ListState;
