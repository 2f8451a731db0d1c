// First pixel of a view in a larger texture.

// Texel of pixel `px` of a view whose `origin` has x in its low half and y in its high half.
fn from_origin(px: vec2u, origin: u32) -> vec2u {
    return px + vec2u(origin & 0xffffu, origin >> 16u);
}
