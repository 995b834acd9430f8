#!/bin/sh
# Rewrites config.ini and the tables of docs/config.md from the program's own parameters.
# usage: docs/update_config.sh path/to/pointplane-odometry
set -eu
program=$(realpath "$1")
cd "$(dirname "$0")/.."
"$program" --dump-config > config.ini
keys=$(mktemp)
"$program" --dump-keys > "$keys"
sed -i -e "/^<!-- keys begin -->$/,/^<!-- keys end -->$/{/^<!-- keys begin -->$/{p;r $keys
};/^<!-- keys end -->$/p;d}" docs/config.md
rm "$keys"
