// The particles: the simulation's own buffers.
#import common/vector
#import fields/position
#import fields/velocity
#import fields/id
