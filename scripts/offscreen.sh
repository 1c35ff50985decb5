#!/usr/bin/env bash
# Run a command as QGIS needs it where there is no screen.
set -euo pipefail

runtime=$(mktemp -d)
trap 'rm -rf "$runtime"' EXIT
# qgis_process takes its Python from PATH, and only the system's fits.
PATH=/usr/bin:/bin QT_QPA_PLATFORM=offscreen XDG_RUNTIME_DIR=$runtime "$@"
