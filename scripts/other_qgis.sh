#!/usr/bin/env bash
# Run tests in the QGIS of another Debian release: a whole system in a folder, entered as root. Nothing is installed here.
#
#   other_qgis.sh SUITE FOLDER PYTEST-ARGUMENT…
#   other_qgis.sh trixie .pythons tests/provider/test_styles.py
#
# It is the QGIS of the release's backports, which "make install" finds there as on every new machine.
set -euo pipefail
suite=$1 folder=$(mkdir -p "$2" && cd "$2" && pwd)/qgis-$1
shift 2
root=$(cd "$(dirname "$0")/.." && pwd)
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo --preserve-env)

if [ ! -d "$folder" ]; then
    command -v debootstrap >/dev/null || "${as_root[@]}" apt-get install -q -y debootstrap
    "${as_root[@]}" rm -rf "$folder.new"
    "${as_root[@]}" debootstrap --variant=minbase --include=ca-certificates,git,make "$suite" "$folder.new" \
        http://deb.debian.org/debian
    "${as_root[@]}" tee -a "$folder.new/etc/apt/sources.list" >/dev/null \
        <<<"deb http://deb.debian.org/debian $suite-backports main"
    "${as_root[@]}" tee "$folder.new/etc/apt/preferences.d/backports" >/dev/null \
        <<<$'Package: *\nPin: release n='"$suite"$'-backports\nPin-Priority: 500'
    "${as_root[@]}" mv "$folder.new" "$folder"
fi

# What belongs to this machine: names of hosts, certificates, and the checkout as it is, without what git ignores.
"${as_root[@]}" cp -L /etc/resolv.conf "$folder/etc/resolv.conf"
"${as_root[@]}" cp -L /etc/ssl/certs/ca-certificates.crt "$folder/etc/ssl/certs/ca-certificates.crt"
"${as_root[@]}" mkdir -p "$folder/checkout"
git -C "$root" ls-files -z --cached --others --exclude-standard --deduplicate |
    tar -C "$root" --null --files-from=- --ignore-failed-read -cf - | "${as_root[@]}" tar -C "$folder/checkout" --no-same-owner -xf -

# The mounts are those of this process and end with it.
"${as_root[@]}" unshare --mount --pid --fork --kill-child bash -euo pipefail -c '
    folder=$1; shift
    mount -t proc proc "$folder/proc"
    mount --rbind /dev "$folder/dev"
    cd "$folder"
    exec env HOME=/root LC_ALL=C.UTF-8 chroot "$folder" bash -euo pipefail -c "
        cd /checkout
        git init -q . 2>/dev/null
        make install .venv/made
        scripts/offscreen.sh .venv/bin/python -m pytest -q \"\$@\"" tests "$@"
' mounts "$folder" "$@"
