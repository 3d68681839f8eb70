//! Every formula against the table that was computed or published elsewhere.

use super::collision::Collision;
use super::elliptical_drop::Ellipse;
use super::still_water::StillWater;
use super::taylor_couette::TaylorCouette;
use super::taylor_green::TaylorGreen;
use super::{channel, ritter, rotating_square};
use crate::study::accuracy::reference::Table;

/// The largest difference between a formula of a row and a column, each over one plus the column's magnitude.
fn largest(table: &Table, column: &str, formula: impl Fn(&dyn Fn(&str) -> f64) -> f64) -> f64 {
    let expected = table.column(column).unwrap();
    assert!(expected.len() > 10, "{} rows", expected.len());
    let off = (0..expected.len()).map(|row| {
        let of_row = |name: &str| table.column(name).unwrap()[row];
        (formula(&of_row) - expected[row]).abs() / (1.0 + expected[row].abs())
    });
    off.fold(0.0, f64::max)
}

#[test]
fn taylor_green_decays() {
    let table = Table::shipped("tgv2d_decay").unwrap();
    let off = largest(&table, "umax", |row| {
        TaylorGreen::unit(row("Re")).largest_speed(row("t"))
    });
    assert!(off < 1e-6, "{off:e}");
    let off = largest(&table, "E_over_E0", |row| {
        let flow = TaylorGreen::unit(row("Re"));
        flow.energy(row("t")) / 0.25
    });
    assert!(off < 1e-6, "{off:e}");
}

#[test]
fn taylor_green_solves_its_equations() {
    // Div u = 0, and du/dt + u·∇u = −∇p/ρ + ν Δu, by central differences.
    let flow = TaylorGreen {
        reynolds: 30.0,
        length: 2.0,
        speed: 1.5,
        density: 3.0,
    };
    let (at, t, h) = ([0.37, 1.21], 0.4, 1e-4);
    let shifted = |axis: usize, by: f64| {
        let mut place = at;
        place[axis] += by;
        place
    };
    let u = flow.velocity(at, t);
    let slope = |axis: usize, component: usize| {
        let along = |by| flow.velocity(shifted(axis, by), t)[component];
        (along(h) - along(-h)) / (2.0 * h)
    };
    assert!((slope(0, 0) + slope(1, 1)).abs() < 1e-6);
    for component in 0..2 {
        let change = (flow.velocity(at, t + h)[component] - flow.velocity(at, t - h)[component]) / (2.0 * h);
        let carried = u[0] * slope(0, component) + u[1] * slope(1, component);
        let push = (flow.pressure(shifted(component, h), t) - flow.pressure(shifted(component, -h), t))
            / (2.0 * h * flow.density);
        let spread = (0..2).map(|axis| {
            let along = |by| flow.velocity(shifted(axis, by), t)[component];
            (along(h) - 2.0 * u[component] + along(-h)) / (h * h)
        });
        let rest = change + carried + push - flow.viscosity() * spread.sum::<f64>();
        assert!(rest.abs() < 1e-4, "{component}: {rest:e}");
    }
}

#[test]
fn channels_start_up() {
    let table = Table::shipped("poiseuille_couette_startup").unwrap();
    let off = largest(&table, "poiseuille_u_over_umax", |row| {
        channel::poiseuille(row("y_over_d"), row("T"))
    });
    assert!(off < 1e-6, "{off:e}");
    let off = largest(&table, "couette_u_over_V0", |row| {
        channel::couette(row("y_over_d"), row("T"))
    });
    assert!(off < 1e-6, "{off:e}");
    // Before anything reaches the middle, and when all has.
    assert!(channel::couette(0.5, 1e-4).abs() < 1e-12);
    assert!((channel::poiseuille(0.5, 1e-4) - 8e-4).abs() < 1e-12, "u = F t");
    assert!((channel::couette(0.25, 50.0) - 0.25).abs() < 1e-12);
}

#[test]
fn cylinders_turn() {
    let flow = TaylorCouette {
        radii: [1.0, 2.0],
        turns: [1.0, 0.0],
        density: 1.0,
    };
    let table = Table::shipped("taylor_couette_ri1_ro2_wi1_wo0").unwrap();
    for (column, of) in [
        ("u_theta", TaylorCouette::speed as fn(&TaylorCouette, f64) -> f64),
        ("omega", TaylorCouette::angular_speed),
        ("p_minus_p_inner", TaylorCouette::pressure),
    ] {
        let off = largest(&table, column, |row| of(&flow, row("r")));
        assert!(off < 1e-6, "{column}: {off:e}");
    }
    let moved = TaylorCouette {
        radii: [0.5, 0.8],
        turns: [-2.0, 3.0],
        density: 1000.0,
    };
    assert!((moved.angular_speed(0.5) + 2.0).abs() < 1e-12 && (moved.angular_speed(0.8) - 3.0).abs() < 1e-12);
    assert_eq!(moved.pressure(0.5), 0.0);
}

#[test]
fn still_water_is_heavier_below() {
    let table = Table::shipped("hydrostatic_weakly_compressible").unwrap();
    for (gamma, name) in [(7.0, "tait"), (1.0, "linear")] {
        let water = |row: &dyn Fn(&str) -> f64| StillWater {
            depth: 2.0,
            gravity: 9.81,
            density: 1000.0,
            sound_speed: row("c_over_sqrt_gH") * (9.81_f64 * 2.0).sqrt(),
            gamma,
        };
        let y = |row: &dyn Fn(&str) -> f64| 2.0 * row("y_over_H");
        let off = largest(&table, &format!("rho_{name}"), |row| {
            water(row).density_at(y(row)) / 1000.0
        });
        assert!(off < 1e-7, "γ = {gamma}: {off:e}");
        let off = largest(&table, &format!("p_{name}"), |row| {
            water(row).pressure(y(row)) / (1000.0 * 9.81 * 2.0)
        });
        assert!(off < 1e-7, "γ = {gamma}: {off:e}");
    }
}

#[test]
fn dams_break() {
    let table = Table::shipped("ritter1892_profile").unwrap();
    let off = largest(&table, "h_over_H", |row| ritter::depth(row("xi")));
    assert!(off < 1e-6, "{off:e}");
    let off = largest(&table, "u_over_sqrt_gH", |row| ritter::speed(row("xi")));
    assert!(off < 2e-6, "{off:e}");
    assert_eq!((ritter::depth(-3.0), ritter::depth(5.0)), (1.0, 0.0));
}

#[test]
fn grains_collide() {
    let table = Table::shipped("dem_lsd_closed_form").unwrap();
    let collision = |row: &dyn Fn(&str) -> f64| Collision {
        restitution: row("e_target"),
        frequency: 1.0,
        speed: 1.0,
    };
    for (column, of) in [
        ("beta", Collision::damping_ratio as fn(&Collision) -> f64),
        ("tc", Collision::duration),
        ("t_max_overlap", Collision::time_of_largest_overlap),
        ("max_overlap", Collision::largest_overlap),
        ("e_clamped", Collision::restitution_without_pull),
    ] {
        let off = largest(&table, column, |row| of(&collision(row)));
        assert!(off < 1e-8, "{column}: {off:e}");
    }
}

#[test]
fn a_drop_is_stretched() {
    let table = Table::shipped("elliptical_drop_monaghan1994").unwrap();
    let off = largest(&table, "A", |row| Ellipse::at(100.0, row("t")).rate);
    assert!(off < 1e-6, "{off:e}");
    let off = largest(&table, "a", |row| Ellipse::at(100.0, row("t")).short);
    assert!(off < 1e-6, "{off:e}");
}

#[test]
fn a_square_that_turns_pulls_itself_together() {
    let table = Table::shipped("rotating_square_patch_initial_pressure").unwrap();
    let off = largest(&table, "p_midline", |row| {
        rotating_square::pressure([row("s_over_L"), 0.5])
    });
    assert!(off < 1e-4, "{off:e}");
    let off = largest(&table, "p_diagonal", |row| {
        rotating_square::pressure([row("s_over_L"); 2])
    });
    assert!(off < 1e-4, "{off:e}");
}
