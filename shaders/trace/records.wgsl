//#use geometry
// Where records are in the heap, and what they are: trace/records.rs and record.rs.

override MATERIALS: u32 = 0u;
override TEXTURES: u32 = 0u;
override TEXELS: u32 = 0u;
override MAP: u32 = 0u;
override ALBEDOS: u32 = 0u;
override PICKS: u32 = 0u;
override PUNCTUAL: u32 = 0u;
override ATTRIBUTES: u32 = 0u;
override MOVING_ATTRIBUTES: u32 = 0u;

const MATERIAL_ROWS: u32 = 12u;
const PUNCTUAL_ROWS: u32 = 4u;
const MAP_ROWS: u32 = 2u;
const NO_TEXTURE: u32 = 0xffffffffu;
const FLAG_MASK: u32 = 1u;
const FLAG_BLEND: u32 = 2u;
const FLAG_DOUBLE_SIDED: u32 = 4u;
const FLAG_VOLUME: u32 = 8u;
const MATERIAL_INDEX: u32 = 0xffffffu;

// A row of a material.
fn material_row(material: u32, row: u32) -> vec4<u32> {
    return load(MATERIALS + material * MATERIAL_ROWS + row);
}

// TriangleRecord: corners, material and one more than its row in the table of lights.
struct Corners {
    v0: vec3<f32>,
    v1: vec3<f32>,
    v2: vec3<f32>,
    material: u32,
    light: u32,
}

// Geometry::triangle
fn corners_of(triangle: u32) -> Corners {
    var at = TRIANGLES + triangle * 3u;
    if MOVES {
        if triangle >= FIRST_MOVING {
            at = MOVING_TRIANGLES + (triangle - FIRST_MOVING) * 3u;
        }
    }
    let r0 = load(at);
    let r1 = load(at + 1u);
    let r2 = load(at + 2u);
    let v0 = bitcast<vec3<f32>>(r0.xyz);
    let v1 = bitcast<vec3<f32>>(r1.xyz);
    let v2 = bitcast<vec3<f32>>(r2.xyz);
    return Corners(v0, v1, v2, r0.w & MATERIAL_INDEX, r2.w);
}

// First element of Geometry::attributes.
fn attributes_of(triangle: u32) -> u32 {
    if MOVES {
        if triangle >= FIRST_MOVING {
            return MOVING_ATTRIBUTES + (triangle - FIRST_MOVING) * 4u;
        }
    }
    return ATTRIBUTES + triangle * 4u;
}
