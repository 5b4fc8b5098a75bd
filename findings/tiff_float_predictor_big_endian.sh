#!/usr/bin/env bash
# libtiff 4.5.0 (Debian 12): the floating-point predictor (3) written into a big-endian file on a little-endian machine
# holds other numbers. The encoder swaps the bytes of samples before it takes them apart into planes of bytes, though
# the predictor's bytes are ordered from the highest on in files of either order. The decoder follows the definition, so
# what `tiffcp -B -c zip:3` writes is read by the same library as other numbers, without a word. A file of the other
# byte order is no valid test input for readers of the predictor unless another program wrote it.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -q libtiff-tools=4.5.0-6+deb12u4 libtiff6=4.5.0-6+deb12u4 > log 2>&1 || { cat log; exit 1; }
for package in ./*.deb; do dpkg-deb -x "$package" root; done
export LD_LIBRARY_PATH="$folder/root/usr/lib/x86_64-linux-gnu" PATH="$folder/root/usr/bin:$PATH"
python3 - << 'PYTHON'
import struct
# 2 x 1 pixels of 32-bit floats, 1.0 and 2.0, as they are.
tags = [(256, 4, 2), (257, 4, 1), (258, 3, 32), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1), (278, 4, 1), (279, 4, 8), (339, 3, 3)]
out = b"II" + struct.pack("<HI", 42, 16) + struct.pack("<2f", 1, 2) + struct.pack("<H", len(tags))
for tag, kind, value in tags: out += struct.pack("<HHII", tag, kind, 1, value)
open("plain.tif", "wb").write(out + bytes(4))
PYTHON
numbers() { # of a file, written without compression
    tiffcp -L -c none "$1" none.tif
    python3 -c '
import struct
b = open("none.tif", "rb").read()
at = struct.unpack("<I", b[4:8])[0]
tags = {struct.unpack("<H", b[i:i + 2])[0]: struct.unpack("<I", b[i + 8:i + 12])[0] for i in range(at + 2, at + 2 + 12 * struct.unpack("<H", b[at:at + 2])[0], 12)}
print(*struct.unpack("<2f", b[tags[273]:tags[273] + 8]))'
}
tiffcp -L -c zip:3 plain.tif little.tif
tiffcp -B -c zip:3 plain.tif big.tif
echo "libtiff $(tiffcp -h 2>&1 | grep -o 'LIBTIFF, Version [0-9.]*' | grep -o '[0-9.]*$' || echo 4.5.0)"
echo "little-endian, predictor 3: $(numbers little.tif)"
echo "big-endian, predictor 3:    $(numbers big.tif)"
[ "$(numbers little.tif)" = "1.0 2.0" ] && [ "$(numbers big.tif)" != "1.0 2.0" ]
