// Offsets of materials, textures and lights in the scene buffer. Twin of src/records.rs and scene/shading_records.rs.

override MATERIALS: u32 = 0u;
override TEXTURES: u32 = 0u;
override TEXELS: u32 = 0u;
override MAP: u32 = 0u;
override ALBEDOS: u32 = 0u;
override PICKS: u32 = 0u;
override PUNCTUAL: u32 = 0u;

const MATERIAL_ROWS: u32 = 12u;
const TEXTURE_ROWS: u32 = 3u;
const PUNCTUAL_ROWS: u32 = 4u;
const MAP_ROWS: u32 = 2u;
const NO_TEXTURE: u32 = 0xffffffffu;
const FLAG_MASK: u32 = 1u;
const FLAG_BLEND: u32 = 2u;
const FLAG_DOUBLE_SIDED: u32 = 4u;
const FLAG_VOLUME: u32 = 8u;

// Row `row` of a material.
fn material_row(material: u32, row: u32) -> vec4u {
    return load(MATERIALS + material * MATERIAL_ROWS + row);
}
