//#use approx
//#use rng
//#use lights
//#use plan
// Shades the hit of every live path: adds emission, samples a light, scatters. Twin of Paths::radiance.

override MAX_DEPTH: u32 = 3u;
// Integrator: 0 multiple importance sampling, 1 light sampling only, 2 scattered rays only.
override INTEGRATOR: u32 = 0u;

const DRAWS_SCATTER: u32 = 1u;
const DRAWS_LIGHT: u32 = 2u;
const DRAWS_MAP: u32 = 3u;
const DRAWS_STRIDE: u32 = 4u;
const SHADOW_RAY_SCALE: f32 = 1.0 - 1.0 / 1048576.0;

// Paths::mis_weight
fn mis_weight(pdf: f32, light_pdf: f32) -> f32 {
    if pdf <= 0.0 || INTEGRATOR == 2u {
        return 1.0;
    }
    if INTEGRATOR == 1u {
        return 0.0;
    }
    return power_heuristic(pdf, light_pdf);
}

fn any_positive(v: vec3f) -> bool {
    return max(v.x, max(v.y, v.z)) > 0.0;
}

// path::spawn_origin; callers check that shading and geometric normal agree about the side.
fn spawn_origin(p: SurfacePoint, side: f32) -> vec3f {
    return offset_ray(p.position, select(-p.geometric, p.geometric, side > 0.0), p.magnitude);
}

fn eval_at(p: SurfacePoint, layers: Layers, wo: vec3f, wi: vec3f) -> Scatter {
    if PHONG {
        let s = phong_eval(p.phong, wo, wi);
        return Scatter(wi, s.value, s.pdf);
    }
    return eval(layers, wo, wi);
}

fn sample_at(p: SurfacePoint, layers: Layers, wo: vec3f, draws: vec4f) -> Scatter {
    if PHONG {
        let s = phong_sample(p.phong, wo, draws.xyz);
        return Scatter(s.wi, s.value, s.pdf);
    }
    return sample(layers, wo, draws);
}

@compute @workgroup_size(WORKGROUP)
fn shade(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= plan[PATHS_ALIVE] {
        return;
    }
    let path = active_path(id.x);
    let bounce = plan[BOUNCE];
    let ray = path_row(path, PATH_DIRECTION);
    let pdf = path_row(path, PATH_ORIGIN).w;
    var throughput = path_row(path, PATH_THROUGHPUT).xyz;
    let record = paths[path * PATH_ROWS + PATH_HIT];
    let hit = Hit(record.x, bitcast<f32>(record.y), bitcast<f32>(record.z), bitcast<f32>(record.w));

    if hit.triangle == NO_TRIANGLE {
        if EFFECT_ENVIRONMENT {
            let found = throughput * (sky(ray.xyz) * mis_weight(pdf, ray.w));
            set_path_row(path, PATH_RADIANCE, path_row(path, PATH_RADIANCE).xyz + found, 0.0);
        }
        return;
    }
    let p = surface_point(hit, ray.xyz);
    if EFFECT_TRANSMISSION {
        if !p.front {
            let depth = p.absorption * -hit.t;
            throughput *= vec3f(exp_approx(depth.x), exp_approx(depth.y), exp_approx(depth.z));
        }
    }
    if EFFECT_EMISSIVE_TRIANGLES {
        if any_positive(p.emitted) {
            let cosine = dot(p.geometric, ray.xyz);
            let found = throughput * (p.emitted * mis_weight(pdf, triangle_pdf(hit.triangle, hit.t, cosine)));
            set_path_row(path, PATH_RADIANCE, path_row(path, PATH_RADIANCE).xyz + found, 0.0);
        }
    }
    if bounce == MAX_DEPTH {
        return;
    }
    let item = work[path];
    let wo = to_local(-ray.xyz, p.x, p.y, p.z);
    var layered: Layers;
    if !PHONG {
        layered = layers(p.surface, wo, ALBEDOS);
    }
    let first = bounce * DRAWS_STRIDE;

    if INTEGRATOR != 2u {
        let draws = path_draws(item.x, item.y, first + DRAWS_LIGHT, frame.key);
        var more = vec4f(0.0);
        if EFFECT_ENVIRONMENT_MAP {
            more = path_draws(item.x, item.y, first + DRAWS_MAP, frame.key);
        }
        let light = sample_light(p, draws, more);
        if light.pdf > 0.0 {
            let wi = to_local(light.direction, p.x, p.y, p.z);
            let scatter = eval_at(p, layered, wo, wi);
            var weight = 1.0;
            if light.can_be_hit && INTEGRATOR == 0u {
                weight = power_heuristic(light.pdf, scatter.pdf);
            }
            let contribution = scatter.value * light.radiance * (weight / light.pdf);
            let side = dot(p.geometric, light.direction);
            if any_positive(contribution) && side * wi.z > 0.0 {
                let origin = spawn_origin(p, side);
                var direction = light.direction;
                var limit = 3.4028234e38;
                if light.distance < FAR {
                    let to = light.direction * light.distance + (p.position - origin);
                    direction = unit(to);
                    limit = sqrt(dot(to, to)) * SHADOW_RAY_SCALE;
                }
                set_path_row(path, PATH_SHADOW, origin, limit);
                set_path_row(path, PATH_SHADOW + 1u, direction, 0.0);
                set_path_row(path, PATH_SHADOW + 2u, throughput * contribution, 0.0);
                lists[2u * frame.capacity + atomicAdd(&counters[SHADOWS], 1u)] = path;
            }
        }
    }

    let draws = path_draws(item.x, item.y, first + DRAWS_SCATTER, frame.key);
    let sampled = sample_at(p, layered, wo, draws);
    if sampled.pdf <= 0.0 {
        return;
    }
    let direction = unit(to_world(sampled.wi, p.x, p.y, p.z));
    let side = dot(p.geometric, direction);
    if side * sampled.wi.z <= 0.0 {
        return;
    }
    throughput *= sampled.value / sampled.pdf;
    if !any_positive(throughput) {
        return;
    }
    set_path_row(path, PATH_ORIGIN, spawn_origin(p, side), sampled.pdf);
    var sky_density = 0.0;
    if EFFECT_ENVIRONMENT {
        sky_density = sky_pdf(direction, sampled.wi.z);
    }
    set_path_row(path, PATH_DIRECTION, direction, sky_density);
    set_path_row(path, PATH_THROUGHPUT, throughput, 0.0);
    let list = ((bounce + 1u) & 1u) * frame.capacity;
    lists[list + atomicAdd(&counters[NEXT], 1u)] = path;
}
