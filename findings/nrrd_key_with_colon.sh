#!/bin/sh
# NRRD says that a line with ":=" is a key and its value. teem (unu) first looks for ": ", and refuses the whole file
# where a key has one, such as "scanner: state:=on"; after ":=" it may stand. A writer must not put ": " into a key, and a
# reader that knows all fields' names need not refuse such a file.
# teem 1.12.0~20160122-5 (Debian 12). Seen: 'failed to parse "scanner" as field identifier'. Exit status 0: still so.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in teem-apps=1.12.0~20160122-5 libteem2=1.12.0~20160122-5; do apt-get -qq download "$package"; done
for package in *.deb; do dpkg -x "$package" root; done
library=$(find "$folder/root" -name 'libteem.so.2*' | head -n 1)
reads() {
    printf 'NRRD0004\ntype: uchar\ndimension: 1\nsizes: 3\nencoding: raw\n%s\n\nabc' "$1" > in.nrrd
    LD_LIBRARY_PATH=$(dirname "$library") root/usr/bin/teem-unu save -f nrrd -i in.nrrd -o out.nrrd > said 2>&1
}
reads 'scanner state:=on: off' || exit 1
echo 'read: "scanner state:=on: off"'
if reads 'scanner: state:=on'; then exit 1; fi
grep 'as field identifier' said
