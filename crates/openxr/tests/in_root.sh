#!/usr/bin/env bash
# Runs a command in the root $1, with Monado as the active runtime and lavapipe as the only Vulkan driver. Arguments may begin
# with VARIABLE=value. What is mounted is seen by this command alone, and is gone when it ends. liblapack and libblas are behind
# Debian's alternatives, which unpacking does not set up.
root="$1"
shift
exec unshare --mount --propagation private bash -c '
    mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && exec chroot "$0" /usr/bin/env -i "$@"' "$root" \
    PATH=/usr/bin:/bin HOME=/root XDG_RUNTIME_DIR=/run/user/0 \
    XR_RUNTIME_JSON=/usr/share/openxr/1/openxr_monado.json VK_DRIVER_FILES=/usr/share/vulkan/icd.d/lvp_icd.json \
    LD_LIBRARY_PATH=/usr/lib/x86_64-linux-gnu/lapack:/usr/lib/x86_64-linux-gnu/blas NODEVICE_SELECT=1 "$@"
