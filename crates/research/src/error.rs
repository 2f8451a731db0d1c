//! Error of experiments that tell no bad input from failed work.

/// Any error; it is printed in one line.
pub type AnyError = Box<dyn std::error::Error + Send + Sync>;
