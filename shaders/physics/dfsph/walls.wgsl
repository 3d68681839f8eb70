// What boundary particles are to a particle; it is the same in every iteration.

struct Walls {
    pull: Packed, // sum of the gradients there, 1/m; w: the rate at which their velocities press the fluid together, 1/s
    lift: Packed, // what pressure that goes on to grow with depth beyond them does, per time, m/s² (wall_lift.wgsl)
}
