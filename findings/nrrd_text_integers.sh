#!/bin/sh
# teem (unu) reads text samples of an integer type by their leading digits, and wraps what the type does not hold,
# without an error: "2e2" is 2, "1.7" is 1, and 300 of unsigned char is 44. A writer that prints integers as "2e2", as
# printf's %g does from a million on, is read wrongly by it; a reader that follows teem shows other numbers than the file.
# teem 1.12.0~20160122-5 (Debian 12). Seen: "1 2" for "1.7, 2e2", "44 255 7" for "300 -1 7". Exit status 0: still so.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in teem-apps=1.12.0~20160122-5 libteem2=1.12.0~20160122-5; do apt-get -qq download "$package"; done
for package in *.deb; do dpkg -x "$package" root; done
library=$(find "$folder/root" -name 'libteem.so.2*' | head -n 1)
unu() { LD_LIBRARY_PATH=$(dirname "$library") root/usr/bin/teem-unu "$@"; }
samples() { # TYPE TEXT
    printf 'NRRD0004\ntype: %s\ndimension: 1\nsizes: %d\nencoding: text\n\n%s\n' "$1" "$3" "$2" > in.nrrd
    unu save -f nrrd -e ascii -i in.nrrd -o - | sed '1,/^$/d' | tr '\n' ' '
}
first=$(samples short '1.7, 2e2' 2)
second=$(samples uchar '300 -1 7' 3)
echo "1.7, 2e2 as short: $first"
echo "300 -1 7 as uchar: $second"
[ "$first" = "1 2 " ] && [ "$second" = "44 255 7 " ]
