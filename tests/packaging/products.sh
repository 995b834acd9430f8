#!/usr/bin/env bash
# Everything that `cmake --install` takes from the build folder is made by the target `pointplane_products`,
# which ./demo builds. products.sh BUILD
set -euo pipefail
build=$(realpath "$1")
made=$(cd "$build" && ninja -t commands pointplane_products)
installed=$(find "$build" -name cmake_install.cmake -not -path '*/_deps/*' -not -path '*/packaging/*/*' -exec cat {} + |
    grep -oE "\"$build/[^\"]+\"" | tr -d '"' | sort -u)
failed=0
count=0
while read -r file; do
    name=${file#"$build/"}
    case $name in
        */cmake_install.cmake | CMakeFiles/Export/* | pointplane-config*.cmake | install_manifest*) continue ;;
    esac
    [[ $name == *.a || $name == bin/* || $name == *.1 || $name == *.so ]] || continue
    count=$((count + 1))
    [[ $made == *"$name"* ]] || { echo "installed, but no product: $name"; failed=1; }
done <<<"$installed"
# Ten libraries and five programs at the least: else this looked at nothing.
((count >= 15)) || { echo "only $count installed files found"; failed=1; }
exit "$failed"
