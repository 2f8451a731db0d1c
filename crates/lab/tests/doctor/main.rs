//! The doctor names planted errors, and accuses no right input.

#[path = "../common/shared_data.rs"]
mod shared_data;

mod clips;
mod confusion;
mod planted;
mod right;
mod twins;
