// What a step notes of its particles for the length of the next one.
#import common/vector

// Bits of numbers that are not negative, which are ordered as the numbers are.
struct Extremes {
    acceleration: atomic<u32>, // the greatest, m/s²
    signal: atomic<u32>, // the greatest sum of a particle's speed and the speed of sound in it, m/s
    sound: atomic<u32>, // the greatest speed of sound, m/s
}

var<storage, read_write> extremes: Extremes;

const GREATEST_BITS: u32 = 0x7f7fffffu; // of a finite number

// Most particles find that another one was faster already, and leave it at that.
fn note_extremes(acceleration: Vector, speed: f32, sound: f32) {
    let strongest = min(bitcast<u32>(length(acceleration)), GREATEST_BITS);
    let signal = min(bitcast<u32>(speed + sound), GREATEST_BITS);
    if strongest > atomicLoad(&extremes.acceleration) {
        atomicMax(&extremes.acceleration, strongest);
    }
    if signal > atomicLoad(&extremes.signal) {
        atomicMax(&extremes.signal, signal);
    }
#if fluid
    let stiffest = min(bitcast<u32>(sound), GREATEST_BITS);
    if stiffest > atomicLoad(&extremes.sound) {
        atomicMax(&extremes.sound, stiffest);
    }
#end
}
