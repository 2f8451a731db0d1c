//#use microfacet
// Twin of src/kernel/albedo.rs. Callers define `load`, which reads a cell of the tables as four words; `tables` is the
// index of their first cell.

const COSINES: u32 = 48u;
const ROUGHNESSES: u32 = 32u;
const GLASS_COSINES: u32 = 24u;
const GLASS_ROUGHNESSES: u32 = 12u;
const GLASS_IORS: u32 = 12u;
const GLASS_BASE: u32 = COSINES * ROUGHNESSES;
const ANISOTROPIC_BASE: u32 = GLASS_BASE + GLASS_COSINES * GLASS_ROUGHNESSES * GLASS_IORS;
const ANISOTROPIC: vec4u = vec4u(12u, 5u, 10u, 5u);
const MIN_ASPECT: f32 = 0.31622777;
const SHEEN_ROOT: f32 = 0.17782794;
const IOR_ROOT: f32 = 0.17191392;

fn albedo_cell(tables: u32, index: u32) -> vec4f {
    return bitcast<vec4f>(load(tables + index));
}

fn albedo_knot(t: f32, count: u32) -> vec2f {
    let x = clamp(t, 0.0, 1.0) * f32(count - 1u);
    let knot = min(floor(x), f32(count - 2u));
    return vec2f(knot, x - knot);
}

fn albedo_cosine(cosine: f32, width: f32) -> f32 {
    let k = (1.0 - 0.75 * width) * width;
    return (cosine * (1.0 + k)) / (cosine + k);
}

fn albedo_between(tables: u32, i: u32, row: u32, x: f32, y: f32) -> vec4f {
    let a = albedo_cell(tables, i);
    let b = albedo_cell(tables, i + 1u);
    let c = albedo_cell(tables, i + row);
    let d = albedo_cell(tables, i + row + 1u);
    let low = a + (b - a) * x;
    let high = c + (d - c) * x;
    return low + (high - low) * y;
}

fn albedo_plane(tables: u32, x: f32, y: f32) -> vec4f {
    let kx = albedo_knot(x, COSINES);
    let ky = albedo_knot(y, ROUGHNESSES);
    return albedo_between(tables, u32(ky.x) * COSINES + u32(kx.x), COSINES, kx.y, ky.y);
}

fn ggx_albedo(tables: u32, cosine: f32, width: f32) -> vec2f {
    let e = albedo_plane(tables, albedo_cosine(cosine, width), sqrt(width));
    return vec2f(e.x, e.x * schlick_weight(cosine) + e.y);
}

fn anisotropic_albedo(tables: u32, wo: vec3f, a: vec2f) -> vec2f {
    let slanted = abs(wo.x) + abs(wo.y);
    var azimuth = 0.5;
    if slanted > 1e-6 {
        azimuth = abs(wo.x) / slanted;
    }
    let aspect = (sqrt(a.y / a.x) - MIN_ASPECT) * (1.0f / (1.0f - MIN_ASPECT));
    let kx = albedo_knot(albedo_cosine(wo.z, a.x), ANISOTROPIC.x);
    let ky = albedo_knot(azimuth, ANISOTROPIC.y);
    let kz = albedo_knot(sqrt(a.x), ANISOTROPIC.z);
    let kw = albedo_knot(aspect, ANISOTROPIC.w);
    let row = ANISOTROPIC.x;
    var parts: array<vec4f, 4>;
    for (var corner = 0u; corner < 4u; corner++) {
        let z = u32(kz.x) + (corner & 1u);
        let w = u32(kw.x) + (corner >> 1u);
        let i = ANISOTROPIC_BASE + ((w * ANISOTROPIC.z + z) * ANISOTROPIC.y + u32(ky.x)) * row + u32(kx.x);
        parts[corner] = albedo_between(tables, i, row, kx.y, ky.y);
    }
    let low = parts[0] + (parts[1] - parts[0]) * kz.y;
    let high = parts[2] + (parts[3] - parts[2]) * kz.y;
    let sum = low + (high - low) * kw.y;
    return vec2f(sum.x, sum.x * schlick_weight(wo.z) + sum.y);
}

fn sheen_albedo(tables: u32, cosine: f32, roughness: f32) -> f32 {
    let y = (roughness - MIN_SHEEN_ROUGHNESS) * (1.0f / (1.0f - MIN_SHEEN_ROUGHNESS));
    let x = (sqrt(sqrt(max(cosine, MIN_SHEEN_COSINE))) - SHEEN_ROOT) * (1.0f / (1.0f - SHEEN_ROOT));
    return albedo_plane(tables, x, y).z;
}

fn glass_albedo(tables: u32, cosine: f32, width: f32, ior: f32, entering: bool) -> vec2f {
    let kx = albedo_knot(sqrt(albedo_cosine(cosine, width)), GLASS_COSINES);
    let ky = albedo_knot(sqrt(width), GLASS_ROUGHNESSES);
    let kz = albedo_knot((sqrt((2.0 * (ior - 1.0)) / (ior + 1.0)) - IOR_ROOT) * (1.0f / (1.0f - IOR_ROOT)), GLASS_IORS);
    let row = GLASS_COSINES;
    let plane = GLASS_COSINES * GLASS_ROUGHNESSES;
    var sums: array<vec4f, 2>;
    for (var k = 0u; k < 2u; k++) {
        let i = GLASS_BASE + (u32(kz.x) + k) * plane + u32(ky.x) * row + u32(kx.x);
        sums[k] = albedo_between(tables, i, row, kx.y, ky.y);
    }
    let e = sums[0] + (sums[1] - sums[0]) * kz.y;
    return select(e.zw, e.xy, entering);
}
