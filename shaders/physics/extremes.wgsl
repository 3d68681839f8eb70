// What a step notes of its particles for the length of the next one.
#import common/vector
#import physics/guard

const GREATEST_BITS: u32 = 0x7f7fffffu; // of a finite number

// Most particles find that another one was faster already, and leave it at that.
fn note_extremes(acceleration: Vector, speed: f32, sound: f32) {
    let strongest = min(bitcast<u32>(length(acceleration)), GREATEST_BITS);
    let signal = min(bitcast<u32>(speed + sound), GREATEST_BITS);
    if strongest > atomicLoad(&guard.extremes.acceleration) {
        atomicMax(&guard.extremes.acceleration, strongest);
    }
    if signal > atomicLoad(&guard.extremes.signal) {
        atomicMax(&guard.extremes.signal, signal);
    }
#if fluid
    let stiffest = min(bitcast<u32>(sound), GREATEST_BITS);
    if stiffest > atomicLoad(&guard.extremes.sound) {
        atomicMax(&guard.extremes.sound, stiffest);
    }
#end
}
