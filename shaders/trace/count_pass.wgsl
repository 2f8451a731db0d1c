//#use frame
// Between the others: what was appended becomes what is alive, and workgroups for it.

// Workgroups along x, y and z of `extend` and `shade`, then of `shadow`.
@group(2) @binding(0) var<storage, read_write> workgroups: array<u32, 6>;

fn count_rays(rays: u32) {
    let before = atomicAdd(&counters[RAYS_LOW], rays);
    if before + rays < before {
        atomicAdd(&counters[RAYS_HIGH], 1u);
    }
}

@compute @workgroup_size(1)
fn start() {
    atomicStore(&counters[BOUNCE], 0u);
    atomicStore(&counters[ACTIVE], frame.items);
    atomicStore(&counters[NEXT], 0u);
    atomicStore(&counters[SHADOWS], 0u);
    count_rays(frame.items);
    workgroups[0] = (frame.items + WORKGROUP - 1u) / WORKGROUP;
    workgroups[1] = 1u;
    workgroups[2] = 1u;
    workgroups[4] = 1u;
    workgroups[5] = 1u;
}

@compute @workgroup_size(1)
fn count_shadows() {
    let shadows = atomicLoad(&counters[SHADOWS]);
    count_rays(shadows);
    workgroups[3] = (shadows + WORKGROUP - 1u) / WORKGROUP;
}

@compute @workgroup_size(1)
fn count_paths() {
    let next = atomicLoad(&counters[NEXT]);
    atomicAdd(&counters[BOUNCE], 1u);
    atomicStore(&counters[ACTIVE], next);
    atomicStore(&counters[NEXT], 0u);
    atomicStore(&counters[SHADOWS], 0u);
    count_rays(next);
    workgroups[0] = (next + WORKGROUP - 1u) / WORKGROUP;
}
