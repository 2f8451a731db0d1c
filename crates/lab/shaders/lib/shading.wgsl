//#use color
//#use direction
// Twin of src/kernel/shading.rs.

const GRAZING: f32 = 1e-3;

// shading::mapped_normal
fn mapped_normal(normal: vec3<f32>, tangent: vec3<f32>, sign: f32, texel: vec3<f32>, scale: f32) -> vec3<f32> {
    let along = unit(tangent - normal * dot(normal, tangent));
    let bitangent = cross(normal, along) * sign;
    let local = texel * 2.0 - vec3<f32>(1.0);
    let xy = local.xy * scale;
    let z = max(local.z, 1e-3);
    return unit(along * xy.x + bitangent * xy.y + normal * z);
}

// shading::visible_normal
fn visible_normal(shading: vec3<f32>, geometric: vec3<f32>, toward: vec3<f32>) -> vec3<f32> {
    let seen = dot(shading, toward);
    if seen >= GRAZING {
        return shading;
    }
    let lifted = unit(shading + toward * (GRAZING - seen));
    return select(geometric, lifted, dot(lifted, geometric) > 0.0 && dot(lifted, toward) > 0.0);
}

// shading::hue
fn hue(color: vec3<f32>) -> vec3<f32> {
    let y = luma(color);
    if y > 1e-6 {
        return color / y;
    }
    return vec3<f32>(1.0);
}

// shading::tint
fn tint(color: vec3<f32>, amount: f32) -> vec3<f32> {
    return vec3<f32>(1.0 - amount) + hue(color) * amount;
}
