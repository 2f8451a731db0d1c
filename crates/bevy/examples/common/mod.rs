//! What the examples and tests share: an application without a window, and a scene.

#![allow(dead_code, reason = "each example and test uses a part")]

pub mod headless;
pub mod scene;
