//! Every function of every module; one test per module, named after its hard cases.

use super::probe::check_module;

/// A test of each module.
macro_rules! bit_equal {
    ($($test:ident: $module:literal;)*) => {$(
        #[test]
        fn $test() {
            check_module($module);
        }
    )*};
}

bit_equal! {
    triangle_is_bit_equal_h80: "triangle";
    octahedral_is_bit_equal: "octahedral";
    direction_is_bit_equal: "direction";
    sampling_is_bit_equal_h83: "sampling";
    microfacet_is_bit_equal_h83: "microfacet";
    phong_is_bit_equal: "phong";
    albedo_is_bit_equal: "albedo";
    bsdf_is_bit_equal_h83: "bsdf";
    layers_is_bit_equal_h83: "layers";
    light_is_bit_equal: "light";
    shading_is_bit_equal: "shading";
    texel_is_bit_equal: "texel";
}
