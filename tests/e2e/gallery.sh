#!/bin/bash
# The gallery's script makes every picture that the page shows, small and of a coarse cell: arguments TESSERA SOURCE_DIR.
# GALLERY_EVERY: of how many pictures in the order of the script one is drawn (4; 1: all); the others are only named.
set -u
tessera=$1
source=$2
every=${GALLERY_EVERY:-4}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
mkdir "$work/out"
cat >"$work/draw" <<EOF2
#!/bin/bash
# The program, but for pictures that are not to be drawn.
for last; do [ "\${before:-}" = -o ] && out=\$last; before=\$last; done
if [ "\$(dirname "\$out")" = "$work/out" ]; then
    number=\$(cat "$work/number" 2>/dev/null || echo 0)
    echo \$((number + 1)) >"$work/number"
    [ \$((number % $every)) = 0 ] || { echo "not drawn" >"\$out"; exit 0; }
fi
exec "$tessera" "\$@"
EOF2
chmod +x "$work/draw"
bash "$source/docs/gallery.sh" "$work/draw" "$work/out" 96x64 '{"nx":5,"ny":9,"nz":21,"times":2}' >"$work/out.txt" 2>&1 || {
    echo "FAILED: gallery.sh"
    cat "$work/out.txt"
    exit 1
}
failures=0
drawn=0
for name in $(grep -o 'pictures/gallery/[a-z0-9-]*\.png' "$source/docs/gallery.md" | xargs -n1 basename); do
    [ -s "$work/out/$name" ] || {
        echo "FAILED: the page shows $name, which the script does not make"
        failures=$((failures + 1))
    }
    [ "$(head -c 4 "$work/out/$name" | tail -c 3)" != PNG ] || drawn=$((drawn + 1))
done
echo "drawn: $drawn of $(cat "$work/number")"
[ "$drawn" -gt $(($(cat "$work/number") / (every + 1))) ] || {
    echo "FAILED: too few are pictures"
    failures=$((failures + 1))
}
exit $((failures > 0))
