//! The `afterimage` command-line tool.
fn main() {}
