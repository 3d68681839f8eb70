// Adds up what the parts of each probe found, and writes a row of samples.
#import common/thread
#import physics/clock
#import physics/sensors/probe

#if swept_sensors
var<storage, read> partial_readings: array<Reading>;
#end
#if point_sensors
var<storage, read> point_readings: array<Reading>;
#end
// Rows of one head, whose `a.x` has the bits of the number of steps, and one reading for each probe.
var<storage, read_write> sensor_samples: array<Reading>;
var<uniform> sample_row: u32;

var<workgroup> thread_readings: array<Reading, GROUP_SIZE>;

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
    thread_readings[thread.local_index] = reading;
    workgroupBarrier();
    for (var reach = GROUP_SIZE / 2u; reach > 0u; reach /= 2u) {
        if thread.local_index < reach {
            thread_readings[thread.local_index] =
                add_readings(kind, thread_readings[thread.local_index], thread_readings[thread.local_index + reach]);
        }
        workgroupBarrier();
    }
    if thread.local_index != 0u {
        return;
    }
    reading = thread_readings[0];
#if point_sensors
    if number >= FIRST_POINT_PROBE {
        reading = point_readings[number - FIRST_POINT_PROBE];
    }
#end
    let row = sample_row * (PROBES + 1u);
    sensor_samples[row + 1u + number] = reading;
    if number == 0u {
        sensor_samples[row] = Reading(vec4f(bitcast<f32>(clock.step), 0.0, 0.0, 0.0), vec4f(0.0));
    }
}
