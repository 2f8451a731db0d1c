//! Foveated sampling of traced frames: where samples go, and what is made of them.

mod acuity;
mod fills;
mod guided;
mod papers;
