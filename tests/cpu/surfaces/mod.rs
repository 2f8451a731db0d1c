//! The methods that store surfaces, smr and taa, on the CPU: the properties that smr's mathematics promises (S1 to S9),
//! storage, formulas against f64, hostile input and analytic scenes.

mod antialiasing;
mod decision;
mod formulas;
mod geometry;
mod hard;
mod hostile;
mod lifecycle;
mod noisy;
mod properties;
mod rig;
mod still;
mod storage;
