// What water looks like, and the sizes of its splats. Metres; colors are linear.

struct Water {
    absorption: vec4f, // per metre
    scatter: vec4f, // what comes back from within deep water
    drop: vec4f, // color of clear drops
    low: vec4f, // where walls cut the surface; far away where sides are open
    high: vec4f,
    radius: f32, // of the spheres that the surface is made from
    drop_radius: f32, // of a particle without neighbors
    reach: f32, // radius of the spheres that thickness is spread over
    volume: f32, // of a particle, m³
    spacing: f32, // the unit of thicknesses in textures
    smoothing: f32, // standard deviation of the surface's filter
    range: f32, // surfaces that are farther apart than this are two (Truong and Yuksel 2018)
    retreat: f32, // how far behind a surface the filter sees what lies beyond the range
    few: f32, // a particle with fewer neighbors is a drop
    many: f32, // one with more is inside the water
    deep: f32, // one with so many is behind others, wherever it is seen from
    spray: f32, // how white spray is: 0 or 1
}

var<storage, read> water: Water;

// Distance along the view's axis where no water is.
const NO_SURFACE: f32 = 1e30;
