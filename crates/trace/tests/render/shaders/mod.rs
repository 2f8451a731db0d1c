//! The tracer's shaders under the rules of all shaders: valid, in the languages of other devices, and without
//! arithmetic that compilers reorder.

#[path = "../../../../lab/tests/twins/backends.rs"]
mod backends;
#[path = "../../../../../tests/gpu/twins/modules.rs"]
mod modules;
#[path = "../../../../../tests/gpu/twins/order.rs"]
mod order;

mod library {
    pub use afterimage_trace::shader::SHADERS;

    /// Modules that define `load`, for those that need it.
    pub const LOADS: &[&str] = &["scene_texture", "scene_storage"];
}
