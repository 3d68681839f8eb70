// The contact law of grains: linear spring and dashpot (Harada 2007, Eq. 9 and 10), with shear and attraction
// (Green 2012). Terms that a scene does not have are not in the shader.
#import common/vector
#if sizes
#import common/sizes
#end

struct Contact {
    spring: f32, // N/m
    damping: f32, // between grains, N·s/m
    wall_damping: f32, // between a grain and a wall, N·s/m
    shear: f32, // N·s/m
    attraction: f32, // N/m
    global_damping: f32, // 1/s
    diameter: f32, // m
    inverse_mass: f32, // 1/kg
}

var<uniform> contact: Contact;

#if sizes
// Of a dashpot, for the restitution of two of the largest: the coefficient for a contact of this share of their effective mass.
fn damping_by_mass(damping: f32, share: f32) -> f32 {
    return damping * sqrt(share);
}
#end

// What the contacts of one grain add up to.
struct ContactSum {
    force: Vector, // N
#if sizes
    size: f32, // the grain's radius over that of the largest
#end
#if measuring
    contacts: u32,
    normal_force: f32, // sum of magnitudes, N
    overlap: f32, // the largest, m
#end
}

// With one more contact of grain i. `normal` points from i to what it touches, `approach` is the other's velocity
// less i's.
fn with_contact(before: ContactSum, normal: Vector, overlap: f32, approach: Vector, damping: f32) -> ContactSum {
    var sum = before;
    let spring_force = contact.spring * overlap;
    let normal_speed = dot(approach, normal);
#if normal_dashpot
    sum.force += (damping * normal_speed - spring_force) * normal;
#else
    sum.force += damping * approach - spring_force * normal;
#end
#if shear
    sum.force += contact.shear * (approach - normal_speed * normal);
#end
#if measuring
    sum.contacts += u32(overlap > 0.0);
    sum.normal_force += abs(spring_force - damping * normal_speed);
    sum.overlap = max(sum.overlap, overlap);
#end
    return sum;
}
