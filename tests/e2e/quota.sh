#!/bin/bash
# What is written into a folder whose quota is used up: arguments TESSERA SOURCE_DIR. Needs root, a loop device and btrfs,
# whose quotas hold for root, too.
tessera=$1
source "$2/tests/e2e/common.bash"
disk=$work/disk
# shellcheck disable=SC2329
clean() {
    cd / && umount "$disk" 2>/dev/null
    rm -rf "$work"
}
skip() {
    echo "skipped: $*"
    exit 77
}
[ "$(id -u)" = 0 ] || skip "only root may mount"
command -v mkfs.btrfs >/dev/null || skip "mkfs.btrfs is not installed (btrfs-progs)"
truncate -s 300M image && mkfs.btrfs -q image >/dev/null 2>&1 || skip "no file system can be made"
mkdir "$disk" && mount -o loop image "$disk" 2>/dev/null || skip "no loop device can be mounted"
trap clean EXIT
btrfs subvolume create "$disk/user" >/dev/null 2>&1 && btrfs quota enable "$disk" >/dev/null 2>&1 &&
    btrfs qgroup limit 4M "$disk/user" >/dev/null 2>&1 || skip "the file system has no quotas"
user=$disk/user
dd if=/dev/zero of="$user/much" bs=1M count=6 >/dev/null 2>&1 && skip "the quota does not hold"
rm "$user/much" && sync -f "$user"

room() { # room KB: leaves so much of the quota; compressed files and holes would not count
    rm -f "$user/filler"
    sync -f "$user"
    dd if=/dev/urandom of="$user/filler" bs=1K count=$((4000 - $1 - $(du -k --apparent-size "$user" | cut -f1))) status=none
    sync -f "$user"
}
exceeded() { # exceeded WHAT COMMAND...: it says so in one line, and leaves nothing but what was there
    local what=$1
    shift
    ls -A "$user" >before.txt
    check "$what" 3 "$@"
    say "quota exceeded" err.txt
    [ "$(wc -l <err.txt)" = 1 ] || fail "$what: not one line: $(cat err.txt)"
    ls -A "$user" >after.txt
    cmp -s before.txt after.txt || fail "$what leaves something: $(diff before.txt after.txt)"
}

"$tessera" generate fuel-cell -o long.tsr --size 24x40x96 --times 4 --lattice cc >/dev/null 2>&1 || die "make data"
"$tessera" unpack long.tsr -o long.raw >/dev/null 2>&1 || die "unpack"
"$tessera" generate fuel-cell -o "$user/run.tsr" --size 24x40x48 --times 1 --lattice cc >/dev/null 2>&1 || die "make an archive"
cp "$user/run.tsr" kept.tsr
"$tessera" unpack kept.tsr -o more.raw >/dev/null 2>&1 || die "unpack more"
python3 - <<'EOF2'
import array, json, random
samples = array.array("f", open("more.raw", "rb").read())
random.seed(1)
array.array("f", [value * (1 + 0.01 * random.random()) for value in samples]).tofile(open("more.raw", "wb"))
about = json.load(open("more.json"))
about["times"] = [5.0]
json.dump(about, open("more.json", "w"))
EOF2
room 60
exceeded "pack" "$tessera" pack long.raw -o "$user/new.tsr" --lattice cc
exceeded "pack over an archive" "$tessera" pack long.raw -o "$user/run.tsr" --lattice cc
cmp -s "$user/run.tsr" kept.tsr || fail "the archive has changed"
exceeded "pack in slabs, with scratch files" "$tessera" pack long.raw -o "$user/new.tsr" --lattice cc --memory 80
exceeded "convert" "$tessera" convert long.tsr -o "$user/new.tsr"
exceeded "unpack" "$tessera" unpack long.tsr -o "$user/new.raw"
exceeded "unpack to .vti" "$tessera" unpack long.tsr -o "$user/new.vti"
exceeded "mesh" "$tessera" mesh long.tsr --channel T --iso 353.4 -o "$user/new.vtp"
exceeded "a picture" "$tessera" render long.tsr --size 2400x1800 -o "$user/new.png"
exceeded "a table" "$tessera" stats long.tsr --all-times --line 0,0,0,0.001,0.002,0.04 --planes 3000 -o "$user/new.csv"
room 100
exceeded "append" "$tessera" pack more.raw --append -o "$user/run.tsr"
check "the archive is whole" 0 "$tessera" verify "$user/run.tsr"
"$tessera" unpack "$user/run.tsr" -o same.raw >/dev/null 2>&1
"$tessera" unpack kept.tsr -o kept.raw >/dev/null 2>&1
cmp -s same.raw kept.raw || fail "its samples have changed"
room 1500
check "with room again" 0 "$tessera" pack more.raw --append -o "$user/run.tsr"
check "it is whole" 0 "$tessera" verify "$user/run.tsr"
finish
