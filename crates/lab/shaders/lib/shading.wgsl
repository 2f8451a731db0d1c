//#use color
//#use direction
// Twin of src/kernel/shading.rs.

const GRAZING: f32 = 1e-3;

fn mapped_normal(normal: vec3f, tangent: vec3f, handedness: f32, texel: vec3f, scale: f32) -> vec3f {
    let along = unit(tangent - normal * dot(normal, tangent));
    let bitangent = cross(normal, along) * handedness;
    let local = texel * 2.0 - vec3f(1.0);
    let xy = local.xy * scale;
    let z = max(local.z, 1e-3);
    return unit(along * xy.x + bitangent * xy.y + normal * z);
}

fn visible_normal(shading: vec3f, geometric: vec3f, toward: vec3f) -> vec3f {
    let seen = dot(shading, toward);
    if seen >= GRAZING {
        return shading;
    }
    let lifted = unit(shading + toward * (GRAZING - seen));
    return select(geometric, lifted, dot(lifted, geometric) > 0.0 && dot(lifted, toward) > 0.0);
}

fn hue(color: vec3f) -> vec3f {
    let y = luma(color);
    if y > 1e-6 {
        return color / y;
    }
    return vec3f(1.0);
}

fn tint(color: vec3f, amount: f32) -> vec3f {
    return vec3f(1.0 - amount) + hue(color) * amount;
}
