//#use quad_pass
//#instead no_albedo sparse_albedo
// Reconstruction of frames that have albedo: quad_pass with sparse_albedo.
