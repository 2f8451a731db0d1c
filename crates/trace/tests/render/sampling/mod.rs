//! Foveated sampling of traced frames: sample positions and reconstruction.

mod acuity;
mod fills;
mod papers;
