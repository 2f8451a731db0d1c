//#use frame
// Counts of live paths and of workgroups, from list lengths; runs between the other kernels.

@group(2) @binding(0) var<storage, read_write> plan: array<u32, 9>;

fn count_rays(rays: u32) {
    let before = atomicAdd(&counters[RAYS_LOW], rays);
    if before + rays < before {
        atomicAdd(&counters[RAYS_HIGH], 1u);
    }
}

fn plan_paths(bounce: u32, paths: u32) {
    atomicStore(&counters[NEXT], 0u);
    atomicStore(&counters[SHADOWS], 0u);
    count_rays(paths);
    plan[0] = (paths + WORKGROUP - 1u) / WORKGROUP;
    plan[1] = 1u;
    plan[2] = 1u;
    plan[BOUNCE] = bounce;
    plan[PATHS_ALIVE] = paths;
}

@compute @workgroup_size(1)
fn start() {
    plan_paths(0u, frame.items);
}

@compute @workgroup_size(1)
fn count_shadows() {
    let shadows = atomicLoad(&counters[SHADOWS]);
    count_rays(shadows);
    plan[3] = (shadows + WORKGROUP - 1u) / WORKGROUP;
    plan[4] = 1u;
    plan[5] = 1u;
    plan[SHADOW_RAYS] = shadows;
}

@compute @workgroup_size(1)
fn count_paths() {
    plan_paths(plan[BOUNCE] + 1u, atomicLoad(&counters[NEXT]));
}
