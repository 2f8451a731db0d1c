//! Sweeps: which points there are, what is kept of them, what the page and the plots say.

mod report;
mod sweep;
