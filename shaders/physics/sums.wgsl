// Figures over all particles.

struct Sums {
    kinetic_energy: f32, // J
    potential_energy: f32, // J
    max_speed: f32, // m/s
    max_overlap: f32, // m
    contacts: u32, // as seen by each particle: a contact of two counts twice
    density_error: f32, // of a fluid, |ρ/ρ₀ − 1|, summed
    max_density_error: f32,
    clamped_pressures: u32, // particles whose pressure counts as zero because it would be negative
    clamped_densities: u32, // those of them that the flow would have thinned further
}

fn add_sums(a: Sums, b: Sums) -> Sums {
    return Sums(
        a.kinetic_energy + b.kinetic_energy,
        a.potential_energy + b.potential_energy,
        max(a.max_speed, b.max_speed),
        max(a.max_overlap, b.max_overlap),
        a.contacts + b.contacts,
        a.density_error + b.density_error,
        max(a.max_density_error, b.max_density_error),
        a.clamped_pressures + b.clamped_pressures,
        a.clamped_densities + b.clamped_densities,
    );
}
