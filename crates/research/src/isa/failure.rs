//! What can go wrong, in words.

/// The value, or what went wrong.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;
