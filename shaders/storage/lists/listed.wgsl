// What each particle was like when it was listed.
#import common/vector

struct Listed {
    place: Packed, // m
#if straight_paths
    motion: Packed, // m/s; zero of boundary particles, which are expected to stay
#end
}
