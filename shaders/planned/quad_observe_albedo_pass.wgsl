//#use quad_observe_pass
//#instead no_albedo sparse_albedo
// Comparison of shaded quads with history in frames that have albedo: quad_observe_pass with sparse_albedo.
