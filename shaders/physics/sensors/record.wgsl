// Adds up what the parts of each probe found, and writes a row of samples.
#import common/thread
#import physics/clock
#import physics/sensors/group
#import physics/sensors/probe

#if swept_sensors
var<storage, read> partial_readings: array<Reading>;
#end
#if point_sensors
var<storage, read> point_readings: array<Reading>;
#end
// Rows of one head, whose `a.x` and `a.y` have the low and the high half of the number of steps, and one reading for each probe.
var<storage, read_write> sensor_samples: array<Reading>;
var<uniform> sample_row: u32;

// One workgroup for each probe.
@compute @workgroup_size(GROUP_SIZE)
fn record_sample(thread: Thread) {
    let number = min(group_index(thread), PROBES - 1u);
    let kind = probes[number].kind;
    var reading = no_reading(kind);
#if swept_sensors
    if number < FIRST_POINT_PROBE {
        for (var part = thread.local_index; part < SENSOR_PARTS; part += GROUP_SIZE) {
            reading = add_readings(kind, reading, partial_readings[number * SENSOR_PARTS + part]);
        }
    }
#end
    reading = group_reading(thread, kind, reading);
    if thread.local_index != 0u {
        return;
    }
#if point_sensors
    if number >= FIRST_POINT_PROBE {
        reading = point_readings[number - FIRST_POINT_PROBE];
    }
#end
    let row = sample_row * (PROBES + 1u);
    sensor_samples[row + 1u + number] = reading;
    if number == 0u {
        // The bits of a small whole number are those of a denormal one, which adapters may take for zero.
        let halves = vec2f(f32(clock.step & 0xffffu), f32(clock.step >> 16u));
        sensor_samples[row] = Reading(vec4f(halves, 0.0, 0.0), vec4f(0.0));
    }
}
