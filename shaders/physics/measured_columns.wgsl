// Columns that are measured once a frame, where somebody asks for them.
#if column_contacts
var<storage, read_write> contacts: array<u32>;
#end
#if column_pressure
var<storage, read_write> pressure: array<f32>; // Pa
#end
#if column_density
var<storage, read_write> density: array<f32>; // kg/m³
#end
