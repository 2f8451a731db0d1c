//#use reconstruction
// Frames without albedo. Functions that are never called: sparse_albedo, which has the same ones, takes the place of
// this module where frames have it.

const HAS_ALBEDO: bool = false;

struct SampleAlbedos {
    albedo: vec3f,
    factor: vec3f,
}

struct PastAlbedos {
    none: u32,
}

struct PixelTexture {
    none: u32,
}

struct Retextured {
    factor: vec3f,
    place_share: f32,
    word: u32,
}

// No albedos.
fn sample_albedos(px: vec2u, view: u32) -> SampleAlbedos {
    return SampleAlbedos();
}

// The same.
fn with_sample(a: SampleAlbedos, at: vec2u, view: u32, c: vec3f, weight: f32) -> SampleAlbedos {
    return a;
}

// The same.
fn with_change(a: SampleAlbedos, is_own: bool, has_surface: bool) -> SampleAlbedos {
    return a;
}

// No albedos.
fn past_albedos(px: vec2u, view: u32) -> PastAlbedos {
    return PastAlbedos();
}

// The same.
fn with_texel(
    a: PastAlbedos,
    word: u32,
    c: vec3f,
    weight: f32,
    place: vec2f,
    same: bool,
    is_nearest: bool,
) -> PastAlbedos {
    return a;
}

// The same.
fn with_shown(a: PastAlbedos, around: AroundStored) -> PastAlbedos {
    return a;
}

// No texture.
fn pixel_texture(
    px: vec2u,
    view: u32,
    level: u32,
    at_edge: bool,
    past: PastAlbedos,
    history: Interpolated,
    is_usable: bool,
    c: vec3f,
    of_sample: vec3f,
) -> PixelTexture {
    return PixelTexture();
}

// The same.
fn of_sample(given: PixelTexture) -> PixelTexture {
    return given;
}

// History as it is.
fn of_history(given: PixelTexture, history: Interpolated) -> Interpolated {
    return history;
}

// No factor.
fn on_sample(given: PixelTexture) -> vec3f {
    return vec3f(1.0);
}

// No change.
fn retexture(
    px: vec2u,
    view: u32,
    given: PixelTexture,
    result: Reconstructed,
    is_new: bool,
    samples: f32,
) -> Retextured {
    return Retextured();
}
