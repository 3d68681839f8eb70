// Counts steps on the device.

struct Clock {
    step_in_segment: u32, // steps since the host last wrote parameters
    step: u32, // steps since the run began
}
