//! Where the eye looked: recorded and synthetic scanpaths, and their resampling to frames.
