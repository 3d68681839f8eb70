// Fields that sensors measure.
#import common/vector
#import physics/present
#if fluid
#import physics/fluid/material
#import physics/fluid/state
#end

// Of particle i; vectors have three components, the others are in x.
fn field_of(i: u32, field: u32) -> vec3f {
    switch field {
        case FIELD_VELOCITY: {
            return to_3d(unpack(velocity[i]));
        }
        case FIELD_SPEED: {
            return vec3f(length(unpack(velocity[i])), 0.0, 0.0);
        }
#if fluid
        case FIELD_PRESSURE: {
            return vec3f(fluid_state[i].y, 0.0, 0.0);
        }
        case FIELD_DENSITY: {
            return vec3f(material_of(i).density * (1.0 + fluid_state[i].x), 0.0, 0.0);
        }
#end
        default: {
            return to_3d(unpack(position[i]));
        }
    }
}
