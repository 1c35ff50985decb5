#!/usr/bin/env bash
# Bring what LiDAR Buildings needs onto a Debian or Ubuntu machine: QGIS, its Python packages, the plugin.
# Every step first looks whether it is done, so that a second run changes nothing.
#
#   install.sh system    QGIS 3.40 or newer and scipy, scikit-learn from the system's packages (asks for root)
#   install.sh profile   laspy, lazrs and the plugin, for you alone, in your QGIS profile
#   install.sh           both
#
# The profile is QGIS's own default one, or the one in the folder that QGIS_CUSTOM_CONFIG_PATH names.
set -euo pipefail

readonly NEEDED_QGIS=3.40
readonly QGIS_PACKAGES=(qgis qgis-providers python3-qgis)
readonly PYTHON_PACKAGES=(python3-numpy python3-scipy python3-sklearn python3-pip python3-venv)
readonly PLUGIN=lidar_buildings
HERE=$(cd "$(dirname "$0")/.." && pwd -P)
PROFILE_FOLDER=${QGIS_CUSTOM_CONFIG_PATH:-${XDG_DATA_HOME:-$HOME/.local/share}/QGIS/QGIS3}/profiles/default
readonly HERE PROFILE_FOLDER

say() { printf '%s\n' "$*"; }
fail() { printf 'install: %s\n' "$*" >&2; exit 1; }

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        fail "System packages are missing and you are neither root nor have sudo; run 'scripts/install.sh system' as root first."
    fi
}

apt_get() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y "$@" </dev/null; }

installed_version() { dpkg-query -W -f='${db:Status-Status} ${Version}' "$1" 2>/dev/null | sed -n 's/^installed //p'; }

is_new_enough() { [ -n "$1" ] && [ "$1" != "(none)" ] && dpkg --compare-versions "${1#*:}" ge "$NEEDED_QGIS"; }

missing_packages() {
    local package version
    for package in "${QGIS_PACKAGES[@]}"; do
        version=$(installed_version "$package")
        is_new_enough "$version" || echo "$package"
    done
    for package in "${PYTHON_PACKAGES[@]}"; do
        [ -n "$(installed_version "$package")" ] || echo "$package"
    done
}

candidate() { apt-cache policy qgis | sed -n 's/^ *Candidate: *//p'; }

# Whether the suite is a source of apt and has a new enough QGIS.
has_qgis_in() {
    local versions version origin
    versions=$(apt-cache madison qgis | tr -d ' ')
    while IFS='|' read -r _ version origin; do
        if [[ $origin == *"$1/"* ]] && is_new_enough "$version"; then return; fi
    done <<<"$versions"
    return 1
}

# Add the backports of this Debian release, from wherever this machine gets the release itself.
add_backports() {
    local codename=$1 site keyring=/usr/share/keyrings/debian-archive-keyring.gpg
    local list=/etc/apt/sources.list.d/$codename-backports.sources
    site=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' "Codename: $codename" | head -n 1)
    [ -n "$site" ] || fail "apt has no source for $codename; add one to /etc/apt/sources.list.d, then run this again."
    say "Adding $codename-backports, which has QGIS $NEEDED_QGIS or newer."
    {
        printf 'Types: deb\nURIs: %s\nSuites: %s-backports\nComponents: main\n' "$site" "$codename"
        if [ -e "$keyring" ]; then printf 'Signed-By: %s\n' "$keyring"; fi
    } | as_root tee "$list" >/dev/null
    if ! apt_get update; then
        as_root rm -f "$list"
        fail "$codename-backports can't be read from where this machine gets its packages; add QGIS $NEEDED_QGIS or newer yourself, then run this again."
    fi
}

install_qgis() {
    local id codename
    if is_new_enough "$(candidate)"; then
        apt_get install --no-install-recommends "${QGIS_PACKAGES[@]}"
        return
    fi
    id=$(. /etc/os-release && echo "$ID")
    codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
    if [ "$id" = debian ] && ! has_qgis_in "$codename-backports"; then add_backports "$codename"; fi
    has_qgis_in "$codename-backports" || fail "LiDAR Buildings needs QGIS $NEEDED_QGIS or newer, this system offers $(candidate); add the repository that QGIS's download page gives for $id $codename, then run this again."
    apt_get install --no-install-recommends -t "$codename-backports" "${QGIS_PACKAGES[@]}"
}

install_system() {
    command -v apt-get >/dev/null || fail "This set-up knows Debian and Ubuntu only; README.md says how to install elsewhere."
    local missing
    missing=$(missing_packages)
    if [ -z "$missing" ]; then
        say "System: QGIS $(installed_version qgis) and its Python packages are there."
        return
    fi
    say "System: installing $(echo "$missing" | tr '\n' ' ')"
    apt_get update
    if grep -q qgis <<<"$missing"; then install_qgis; fi
    apt_get install --no-install-recommends "${PYTHON_PACKAGES[@]}"
}

has_packages() {
    PYTHONPATH=$PROFILE_FOLDER/python /usr/bin/python3 - "$HERE/requirements.txt" <<'PY' 2>/dev/null
import re, sys
from importlib.metadata import version

def release(text):
    return [int(number) for number in re.findall(r"\d+", text)[:3]]

for line in open(sys.argv[1]):
    name, low, high = re.match(r"(?:(\w+)>=([\d.]+),<([\d.]+))?", line).groups()
    if name:
        __import__(name)
        assert release(low) <= release(version(name)) < release(high)
PY
}

install_packages() {
    if has_packages; then
        say "Profile: laspy and lazrs are there."
        return
    fi
    say "Profile: installing laspy and lazrs into $PROFILE_FOLDER/python"
    mkdir -p "$PROFILE_FOLDER/python"
    # Without --no-deps pip would put a second numpy next to QGIS's own and break scipy and GDAL.
    PIP_ROOT_USER_ACTION=ignore /usr/bin/python3 -m pip install --quiet --no-deps --upgrade --target "$PROFILE_FOLDER/python" \
        -r "$HERE/requirements.txt"
    has_packages || fail "laspy and lazrs were installed into $PROFILE_FOLDER/python but can't be imported by /usr/bin/python3."
}

link_plugin() {
    local link=$PROFILE_FOLDER/python/plugins/$PLUGIN
    if [ -L "$link" ] && [ "$(readlink -f "$link")" = "$HERE" ]; then return; fi
    if [ -e "$link" ] && [ ! -L "$link" ]; then
        fail "$link is another copy of the plugin; uninstall it in QGIS's plugin manager, then run this again."
    fi
    say "Profile: linking $link to $HERE"
    mkdir -p "$PROFILE_FOLDER/python/plugins"
    ln -sfn "$HERE" "$link"
}

is_enabled() {
    sed -n '/^\[PythonPlugins\]/,/^\[/p' "$PROFILE_FOLDER/QGIS/QGIS3.ini" 2>/dev/null | grep -qx "$PLUGIN=true"
}

enable_plugin() {
    if is_enabled; then
        say "Profile: the plugin is enabled."
        return
    fi
    say "Profile: enabling the plugin"
    local log
    log=$("$HERE/scripts/offscreen.sh" qgis_process plugins enable "$PLUGIN" 2>&1) || true
    is_enabled || fail "QGIS could not enable the plugin; it said: $log"
}

install_profile() {
    install_packages
    link_plugin
    enable_plugin
}

case "${1:-all}" in
    system) install_system ;;
    profile) install_profile ;;
    all) install_system; install_profile ;;
    *) fail "unknown step '$1'; it is system, profile or nothing." ;;
esac
