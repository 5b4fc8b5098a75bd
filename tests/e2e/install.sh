#!/bin/bash
# What is installed works wherever it is moved to, and finds its own layouts and importer. Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$source/tests/e2e/common.bash"
build=$(dirname "$tessera")
has_importer() { [ -x "$build/tessera-import" ]; }
programs=(tessera)
if has_importer; then programs+=(tessera-import); fi

cmake --install "$build" --prefix "$work/first" > log 2>&1 || { cat log; die "cmake --install"; }
mv first moved
moved=$work/moved
for program in "${programs[@]}"; do [ -x "$moved/bin/$program" ] || die "no $program"; done

# A layout that only the installed folder has is known, one that it lacks is not: nothing is read from the sources.
mv "$moved/share/tessera/layouts/overview.json" "$moved/share/tessera/layouts/only-here.json"
check "an installed layout" 0 "$moved/bin/tessera" render --layout only-here -o overview.png --size 480x300
check "a layout of the sources" 2 "$moved/bin/tessera" render --layout overview -o none.png --size 480x300
check "the same picture" 0 "$tessera" render --layout overview -o from-build.png --size 480x300
cmp -s overview.png from-build.png || fail "the installed program draws another picture"

if has_importer; then
    "$tessera" generate fuel-cell --even -o cell.tsr --size 7x13x20 --times 1 > /dev/null || die "generate"
    "$tessera" unpack cell.tsr -o cell.vti > /dev/null || die "unpack"
    check "its own importer reads" 0 env -u TESSERA_IMPORT "$moved/bin/tessera" info cell.vti
    mv "$moved/bin/tessera-import" elsewhere
    check "no other importer is taken" 2 env -u TESSERA_IMPORT "$moved/bin/tessera" info cell.vti
fi

if ls "$build"/python/tessera/_tessera*.so > /dev/null 2>&1 && /usr/bin/python3 -c "import numpy" 2> /dev/null; then
    "$tessera" generate fuel-cell --even -o python.tsr --size 7x13x20 --times 1 > /dev/null || die "generate"
    check "the installed Python package reads" 0 env PYTHONPATH="$moved/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1 \
        /usr/bin/python3 -c 'import tessera; print(tessera.__file__, tessera.open("python.tsr")["T"].shape)'
    say "^$moved/.*(1, 20, 13, 7)" out.txt
fi

# The C example of the documentation, with what is installed. (Not with sanitizers, which the program would need too.)
if ! grep -q "^TESSERA_SANITIZE:BOOL=ON" "$build/CMakeCache.txt" && command -v cc > /dev/null && command -v pkg-config > /dev/null; then
    sed -n '/^```c$/,/^```$/p' "$source/docs/archives.md" | sed '/^```/d' > solver.c
    [ "$(wc -l < solver.c)" -gt 20 ] || fail "docs/archives.md has no solver in C"
    export PKG_CONFIG_PATH
    PKG_CONFIG_PATH=$(dirname "$(find "$moved" -name tessera_writer.pc)")
    # shellcheck disable=SC2046
    check "the C example" 0 cc -Wall -Wextra -Werror solver.c -o solver $(pkg-config --cflags --libs tessera_writer)
    check "it runs" 0 env LD_LIBRARY_PATH="$(pkg-config --variable=libdir tessera_writer)" ./solver
    check "its archive" 0 "$tessera" info live.tsr
    say "times *10" out.txt
fi

# What desktops and people read.
for file in share/applications/tessera.desktop share/mime/packages/tessera.xml share/man/man1/tessera.1 \
    share/icons/hicolor/scalable/apps/tessera.svg share/doc/tessera/README.md share/doc/tessera/LICENSE \
    share/doc/tessera/docs/guide.md; do
    [ -s "$moved/$file" ] || fail "no $file"
done
"$tessera" --help | sed -n '/^Subcommands:/,$ s/^  \([a-z]\+\) .*/\1/p' > commands
[ "$(wc -l < commands)" -gt 10 ] || fail "tessera --help names few commands"
while read -r command; do say "^\.B $command\$" "$moved/share/man/man1/tessera.1"; done < commands

# Each page refers to others, and all of them are installed; the importer's page names each suffix that it reads.
pages=$moved/share/man
for page in "$pages"/man*/*; do
    name=${page##*/}
    sed -n '/^\.SH SEE ALSO/,$ s/^\.BR \([^ ]\+\) (\([0-9]\)).*/man\2\/\1.\2/p' "$page" | tr -d '\\' > references
    [ -s references ] || fail "$name refers to no other page"
    while read -r other; do [ -s "$pages/$other" ] || fail "$name refers to $other, which is not installed"; done < references
    if command -v groff > /dev/null; then
        groff -man -ww -z "$page" 2> warnings
        [ ! -s warnings ] || fail "$name: $(cat warnings)"
    fi
done
if has_importer; then [ -s "$pages/man1/tessera-import.1" ] || fail "tessera-import has no page"; fi
sed -n 's/^TESSERA_FORMAT("[^"]*", "\([^"]*\)".*/\1/p' "$source/volume/import/files/format_rows.inc" | tr ' ' '\n' > suffixes
[ "$(wc -l < suffixes)" -gt 30 ] || fail "format_rows.inc names few suffixes"
sed 's/\\&//g' "$pages/man1/tessera-import.1" | tr ' ,' '\n' > words
while read -r suffix; do grep -qFx -e "$suffix" words || fail "tessera-import.1 does not name $suffix"; done < suffixes
finish
