#![cfg(feature = "lab")]
mod table;
