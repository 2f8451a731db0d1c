//! The doctor names planted errors, and accuses no right input.

mod clips;
mod confusion;
mod planted;
mod right;
mod twins;
