//! What the examples and tests share: an application without a window, and scenes.

#![allow(dead_code, reason = "each example and test uses a part")]

pub mod crowd;
pub mod grille;
pub mod headless;
pub mod scene;
