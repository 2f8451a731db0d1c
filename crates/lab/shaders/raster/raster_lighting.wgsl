//#use bsdf
//#use direction
//#use light
//#use lighting_maps
//#use raster_frame
// Light that a point of a surface sends to the eye, by the tracer's scattering functions: it is lit by punctual lights,
// panels, the sun and the sky. Indirect light is an estimate (`bounced`).

override HAS_SUN: bool = true;

struct LitPoint {
    position: vec3f,
    // Direction to the eye.
    toward: vec3f,
    // Normal of the triangle, on the eye's side.
    geometric: vec3f,
    normal: vec3f,
    // Of the texture coordinates; needed where highlights are anisotropic.
    tangent: vec3f,
    emitted: vec3f,
    surface: BsdfSurface,
}

// Ambient irradiance from six faces, weighted by the squared components of the normal, whose sum is 1.
fn ambient_at(normal: vec3f) -> vec3f {
    let share = normal * normal;
    let x = select(lights.ambient[1], lights.ambient[0], normal.x >= 0.0).xyz;
    let y = select(lights.ambient[3], lights.ambient[2], normal.y >= 0.0).xyz;
    let z = select(lights.ambient[5], lights.ambient[4], normal.z >= 0.0).xyz;
    return (x * share.x + y * share.y) + z * share.z;
}

// Share of uniform light from all sides that a surface returns towards the eye, by its diffuse lobe and its
// reflections; not what shines through it, nor what it emits.
fn albedo_of(l: Layers, cosine: f32) -> vec3f {
    var albedo = l.diffuse * PI;
    if LOBE_SPECULAR || LOBE_METAL {
        let e = ggx_albedo(0u, cosine, ggx_mean_width(l.widths));
        albedo += l.reflect * e.x + l.reflect_rise * e.y;
    }
    if LOBE_CLEARCOAT {
        let e = ggx_albedo(0u, cosine, l.coat_width);
        albedo += vec3f(l.coat * e.x + l.coat_rise * e.y);
    }
    return albedo;
}

struct Incoming {
    direction: vec3f,
    // On a surface facing the light.
    irradiance: vec3f,
}

fn incoming(light: RasterLight, position: vec3f) -> Incoming {
    if light.kind == 0u {
        return Incoming(-light.direction, light.intensity);
    }
    let to = light.position - position;
    let square = dot(to, to);
    let direction = unit(to);
    let cosine = -dot(direction, light.direction);
    if light.kind >= 3u {
        // Irradiance of a disk of the panel's area on its axis, times the cosine off the axis.
        let seen = select(max(cosine, 0.0), abs(cosine), light.kind == 4u);
        return Incoming(direction, light.intensity * (seen * light.area / (square + light.area * FRAC_1_PI)));
    }
    var irradiance = light.intensity * distance_falloff(sqrt(square), light.range);
    if light.kind == 2u {
        irradiance *= cone_falloff(cosine, light.cos_inner, light.cos_outer);
    }
    return Incoming(direction, irradiance);
}

// First axis of a point's local frame; the normal is the third.
fn first_axis(p: LitPoint) -> vec3f {
    if LOBE_ANISOTROPY && p.surface.anisotropy > 0.0 {
        let along = p.tangent - p.normal * dot(p.normal, p.tangent);
        if dot(along, along) > 1e-12 {
            return unit(along);
        }
    }
    return basis(p.normal)[0];
}

fn albedo_at(p: LitPoint) -> vec3f {
    let x = first_axis(p);
    let wo = to_local(p.toward, x, cross(p.normal, x), p.normal);
    return albedo_of(layers(p.surface, wo, 0u), wo.z);
}

fn radiance_at(p: LitPoint) -> vec3f {
    let x = first_axis(p);
    let y = cross(p.normal, x);
    let wo = to_local(p.toward, x, y, p.normal);
    let l = layers(p.surface, wo, 0u);
    var color = p.emitted;
    for (var i = 0u; i < lights.count; i++) {
        let light = lights.lights[i];
        let arriving = incoming(light, p.position);
        var share = select(0.0, 1.0, dot(arriving.direction, p.geometric) > 0.0 || LOBE_TRANSMISSION);
        if HAS_SUN && light.has_shadow > 0.0 && share > 0.0 {
            share *= sunlit(p.position, p.geometric);
        }
        let value = eval(l, wo, to_local(arriving.direction, x, y, p.normal)).value;
        color += value * arriving.irradiance * share;
    }

    // Ambient light: diffuse lobes use irradiance; highlights use sky radiance in the mirror direction.
    let reflected = unit(p.normal * (2.0 * wo.z) - p.toward);
    color += l.diffuse * (ambient_at(p.normal) + lights.bounced * PI);
    if LOBE_SPECULAR || LOBE_METAL || LOBE_TRANSMISSION {
        let e = ggx_albedo(0u, wo.z, ggx_mean_width(l.widths));
        let around = sky_radiance(reflected, p.surface.roughness) + lights.bounced;
        color += (l.reflect * e.x + l.reflect_rise * e.y) * around;
        if LOBE_TRANSMISSION {
            color += l.glass * l.glass_reflect * fresnel_dielectric(wo.z, l.eta) * around;
        }
    }
    if LOBE_CLEARCOAT {
        let e = ggx_albedo(0u, wo.z, l.coat_width);
        color += (l.coat * e.x + l.coat_rise * e.y) * (sky_radiance(reflected, p.surface.clearcoat_roughness) + lights.bounced);
    }
    return color;
}
