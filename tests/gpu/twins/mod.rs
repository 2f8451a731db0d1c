//! The WGSL library against the Rust kernel, function by function, bit for bit; hard cases H01-H04, H15, H17-H21, H23,
//! H28, H30-H39, H41, H42, H45, H47, H54, H57, H61, H64, H65, H71, H80, H83.

mod antialias;
mod bindings;
mod composer;
mod controls;
mod decisions;
mod demodulation;
mod doctor;
mod foveation;
mod functions;
mod hard;
mod lattice;
mod lens;
mod library;
mod matching;
mod mathematics;
mod modules;
mod names;
mod noise;
mod order;
mod probe;
mod quads;
mod shape;
mod sparse;
mod state;
mod surfaces;
mod upsampling;
mod values;
mod weighted;

use afterimage_testing::Draws;
use glam::{Vec2, Vec3, Vec4};
use probe::{Probe, Rows, probe};
use shape::*;
use values::Word::*;
use values::*;
