#!/bin/bash
# The gallery's script renders every picture that the page shows, small and of a coarse cell: arguments TESSERA
# SOURCE_DIR.
set -u
tessera=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
bash "$source/docs/gallery.sh" "$tessera" "$work" 96x64 '{"nx":5,"ny":9,"nz":21,"times":2}' >"$work/out.txt" 2>&1 || {
    echo "FAILED: gallery.sh"
    cat "$work/out.txt"
    exit 1
}
failures=0
for name in $(grep -o 'pictures/gallery/[a-z0-9-]*\.png' "$source/docs/gallery.md" | xargs -n1 basename); do
    [ -s "$work/$name" ] || {
        echo "FAILED: the page shows $name, which the script does not make"
        failures=$((failures + 1))
    }
done
exit $((failures > 0))
