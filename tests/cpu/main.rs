//! The CPU executor: whole passes, method by method, and the simulators of foveation.

#[path = "../common/mod.rs"]
mod common;
mod pass;
mod simulator;
mod surfaces;

use common::*;
