//! Rays and triangles: hierarchies against brute force, watertightness, degenerate input, CPU against GPU; hard cases H80, H81,
//! H82.
#![cfg(feature = "lab")]

#[path = "../common/mod.rs"]
mod common;

mod brute_force;
mod degenerate;
mod records;
mod scenes;
mod self_intersection;
mod watertight;
