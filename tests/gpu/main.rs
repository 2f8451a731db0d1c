//! The GPU executor against its twin on the CPU: function by function, then whole sequences, decisions and stored
//! state, bit for bit.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/kernel_hard.rs"]
mod kernel_hard;
mod pass;
mod simulator;
mod twins;

use common::*;
