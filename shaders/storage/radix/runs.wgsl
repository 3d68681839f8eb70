// Particles are sorted by one digit of their voxel at a time; each thread takes a run of RUN particles.
#import common/parameters

const DIGITS: u32 = 1u << DIGIT_BITS;

// Runs that hold all particles.
fn runs() -> u32 {
    return (parameters.particle_count + RUN - 1u) / RUN;
}
