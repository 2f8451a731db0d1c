//! The rules of the house: checks over the files of the workspace.
//!
//! Each rule is a function from text to a list of violations. A test applies it to the workspace, another to a small input with
//! a planted violation.

mod modules;
mod paths;
mod prose;

mod tree;
mod words;
