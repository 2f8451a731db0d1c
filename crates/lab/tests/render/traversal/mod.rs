//! Traversal: hierarchies against brute force, watertightness, degenerate input; hard cases H80, H81,
//! H82.

mod brute_force;
mod degenerate;
mod records;
mod scenes;
mod self_intersection;
mod watertight;
