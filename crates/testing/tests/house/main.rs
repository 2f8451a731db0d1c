//! The rules of the house: checks over the files of the workspace.
//!
//! Each rule is a function from text to a list of violations. One test applies it to the workspace, another to a small
//! input with planted violations.

mod commands;
mod manifests;
mod modules;
mod page_tables;
mod paths;
mod properties;
mod prose;
mod rooms;
mod shader_comments;
mod shader_names;
mod shader_tables;
mod tree;
mod twin_constants;
mod uses;
mod words;
