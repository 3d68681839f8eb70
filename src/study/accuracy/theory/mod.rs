//! Exact solutions, in f64, without units unless said: each test compares one with a table in `assets/reference/`.

pub mod channel;
pub mod collision;
pub mod elliptical_drop;
pub mod ritter;
pub mod rotating_square;
pub mod still_water;
pub mod taylor_couette;
pub mod taylor_green;

#[cfg(test)]
mod tests;
