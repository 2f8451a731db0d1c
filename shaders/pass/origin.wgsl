// First pixel of a view in a larger texture.

// Texel of pixel `px` of a view whose `origin` has x in its low half and y in its high half.
fn from_origin(px: vec2<u32>, origin: u32) -> vec2<u32> {
    return px + vec2<u32>(origin & 0xffffu, origin >> 16u);
}
