#!/usr/bin/env bash
# A small Debian trixie root in $1 with Monado, the OpenXR loader and headers, validation layers and lavapipe: bookworm has no
# Monado. Needs root, apt and Debian's keyring. 190 MB to download. Packages are unpacked, not configured: no maintainer
# script runs.
set -euo pipefail
root="$1"
apt="$root.apt"
mkdir -p "$root" "$apt/lists/partial" "$apt/cache/archives/partial"
# The mirror that this machine's own apt uses.
mirror=$(cat /etc/apt/sources.list.d/*.sources 2>/dev/null | sed -n 's/^URIs: *//p' | head -n 1) || true
[ -n "$mirror" ] || mirror=$(awk '$1 == "deb" {print $2; exit}' /etc/apt/sources.list)
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror trixie main" >"$apt/trixie.list"
: >"$apt/status"
opts=(-o Dir::Etc::SourceList="$apt/trixie.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$apt/lists"
    -o Dir::Cache="$apt/cache" -o Dir::State::status="$apt/status" -o APT::Install-Recommends=false -o Debug::NoLocking=1)
packages=(monado-service libopenxr1-monado libopenxr-loader1 libopenxr-dev openxr-layer-corevalidation mesa-vulkan-drivers
    vulkan-validationlayers xvfb bash coreutils libc-bin base-files procps)
apt-get "${opts[@]}" -qq update
apt-get "${opts[@]}" -qq install -d -y "${packages[@]}" >/dev/null
for d in bin sbin lib lib64; do
    mkdir -p "$root/usr/$d"
    [ -e "$root/$d" ] || ln -s "usr/$d" "$root/$d"
done
for deb in "$apt"/cache/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$deb" | tar -x -C "$root" --keep-directory-symlink --exclude='./usr/share/doc/*' \
        --exclude='./usr/share/man/*' --exclude='./usr/share/locale/*'
done
rm -rf "$apt"
ldconfig -r "$root"
mkdir -p "$root"/{proc,dev,sys,run/user/0,tmp,root,xr/layers}
chmod 1777 "$root/tmp"
# Xvfb starts xkbcomp by a shell.
[ -e "$root/usr/bin/sh" ] || ln -s bash "$root/usr/bin/sh"
touch "$root/xr/complete"
