// Counts steps on the device.

struct Clock {
    step_in_segment: u32, // steps since the host last changed something
    step: u32, // steps since the run began
}

#if advances_clock
var<storage, read_write> clock: Clock;
#else
var<storage, read> clock: Clock;
#end
