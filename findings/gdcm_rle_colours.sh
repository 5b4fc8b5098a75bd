#!/bin/sh
# DICOM's RLE (PS3.5, annex G) keeps one packed segment for each byte of a pixel: of colours with 16 bits the high and the
# low byte of red, of green, of blue. GDCM decodes such a file without an error to other numbers: red 65535, green 0,
# blue 0 becomes 0, 65280, 255. With 8 bits, and with 16 bits of grey, it is right.
# gdcm 3.0.21-1 (Debian 12). Seen: "0 65280 255". Exit status 0: still so.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in libgdcm-tools=3.0.21-1 libgdcm3.0=3.0.21-1 libcharls2 libsocket++1 libopenjp2-7 libjson-c5; do
    apt-get -qq download "$package"
done
for package in *.deb; do dpkg -x "$package" root; done
python3 - <<'EOF'
import struct
def element(group, number, kind, data):
    data += b'\0' * (len(data) % 2)
    head = struct.pack('<HH', group, number) + kind
    long = kind in (b'OB', b'OW', b'SQ')
    return head + (b'\0\0' + struct.pack('<I', len(data)) if long else struct.pack('<H', len(data))) + data
word = lambda value: struct.pack('<H', value)
meta = element(2, 0x10, b'UI', b'1.2.840.10008.1.2.5')
data = element(8, 0x16, b'UI', b'1.2.840.10008.5.1.4.1.1.7') + element(8, 0x18, b'UI', b'1.2.3')
data += element(0x28, 2, b'US', word(3)) + element(0x28, 4, b'CS', b'RGB') + element(0x28, 6, b'US', word(0))
data += element(0x28, 0x10, b'US', word(2)) + element(0x28, 0x11, b'US', word(4))
data += element(0x28, 0x100, b'US', word(16)) + element(0x28, 0x101, b'US', word(16))
data += element(0x28, 0x102, b'US', word(15)) + element(0x28, 0x103, b'US', word(0))
segments = [bytes([257 - 8, value]) for value in (255, 255, 0, 0, 0, 0)]  # 8 equal pixels: red
offsets = [64 + 2 * n for n in range(6)]
frame = struct.pack('<16I', 6, *offsets, *[0] * 9) + b''.join(segments)
item = lambda body: struct.pack('<HHI', 0xfffe, 0xe000, len(body)) + body
pixels = struct.pack('<HH', 0x7fe0, 0x10) + b'OB\0\0' + struct.pack('<I', 0xffffffff) + item(b'') + item(frame)
pixels += struct.pack('<HHI', 0xfffe, 0xe0dd, 0)
meta = element(2, 0, b'UL', struct.pack('<I', len(meta))) + meta
open('rle.dcm', 'wb').write(b'\0' * 128 + b'DICM' + meta + data + pixels)
EOF
LD_LIBRARY_PATH=$(dirname "$(find "$folder/root" -name 'libgdcmMSFF.so.3.0' | head -n 1)") \
    root/usr/bin/gdcmconv --raw -i rle.dcm -o raw.dcm
seen=$(tail -c 48 raw.dcm | od -An -v -tu2 | head -n 1 | awk '{print $1, $2, $3}')
echo "red 65535, green 0, blue 0 is read as: $seen"
[ "$seen" = "0 65280 255" ]
