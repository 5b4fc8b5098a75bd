#!/bin/bash
# Archives on other machines: a web server on this one that gives ranges and misbehaves on demand (remote_server.py), ssh
# by a stand-in (fake_ssh.py), and by a real sshd where there is one. Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$2/tests/e2e/common.bash"
command -v python3 > /dev/null || { echo "skipped: no python3"; exit 77; }
export XDG_CACHE_HOME=$work/cache HOME=$work
unset CURL_CA_BUNDLE SSL_CERT_FILE http_proxy https_proxy all_proxy HTTP_PROXY HTTPS_PROXY ALL_PROXY
mkdir served

# Numbers without pattern, which no coder makes smaller: 36 MB in 216 bricks, more than are drawn from one texture.
python3 -c 'import random; open("big.raw", "wb").write(random.Random(1).randbytes(330**3))'
echo '{"dims": [330, 330, 330], "dtype": "uint8", "components": [{"name": "a"}]}' > big.json
"$tessera" pack big.json -o served/big.tsr --lattice cc > /dev/null 2> err || die "pack"
"$tessera" generate fuel-cell -o served/cell.tsr --size 17x21x20 --times 3 > /dev/null 2> err || die "generate"
python3 -c 'open("middle.raw", "wb").write(open("big.raw", "rb").read()[:160**3])'
sed 's/330/160/g' big.json > middle.json
"$tessera" pack middle.json -o served/middle.tsr --lattice cc > /dev/null 2> err || die "pack"
big=$(stat -c %s served/big.tsr) middle=$(stat -c %s served/middle.tsr)

certificate=()
openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext subjectAltName=DNS:localhost \
    -keyout key.pem -out certificate.pem 2> err && certificate=("$work/certificate.pem" "$work/key.pem")
python3 "$source/tests/e2e/remote_server.py" "$work/served" "$work/port" "${certificate[@]}" > server.log 2>&1 &
server=$!
trap 'kill $server; rm -rf "$work"' EXIT
for ((i = 0; i < 100; ++i)); do [ -s port ] && break; sleep 0.1; done
read -r port secure < port || [ -n "$port" ] || die "no server"
at=http://127.0.0.1:$port
way() { python3 -c 'import sys, urllib.request as u; u.urlopen(sys.argv[1]).read()' "$at/set?$1"; }
told() { python3 -c 'import sys, urllib.request as u; print(u.urlopen(sys.argv[1]).read().decode().strip())' "$at/told"; }
# sent WHAT LEAST MOST: bytes of files sent since the last call.
sent() {
    read -r bytes requests most logins <<< "$(told)"
    echo "$1: $bytes bytes in $requests requests, $most at a time"
    [ "$bytes" -ge "$2" ] && [ "$bytes" -le "$3" ] || fail "$1: $bytes bytes, not $2 to $3"
}
forget() { rm -rf cache; told > /dev/null; }

# The same as of the file itself.
same() { # same WHAT ARGUMENTS..., in which FILE stands for the archive
    local what=$1 name=$2
    shift 2
    check "$what, local" 0 "$tessera" "${@//FILE/served/$name}"
    mv out.txt local.txt
    check "$what, remote" 0 "$tessera" "${@//FILE/$at/$name}"
    sed -i "s#served/#$at/#g" local.txt
    cmp local.txt out.txt || fail "$what differs"
}
same info cell.tsr info FILE
same "info of bricks" cell.tsr info FILE --bricks --json
same stats cell.tsr stats FILE
same verify cell.tsr verify FILE
check unpack 0 "$tessera" unpack served/cell.tsr -o local.raw
check "unpack, remote" 0 "$tessera" unpack $at/cell.tsr -o remote.raw
cmp local.raw remote.raw || fail "other samples"
check "convert" 0 "$tessera" convert $at/cell.tsr -o copy.tsr
same "redirected" elsewhere.tsr info $at/big.tsr

# Only what is asked for is sent, and only once.
forget
check "info of much" 0 "$tessera" info $at/big.tsr
sent "info" 1000 200000
check "a coarse level" 0 "$tessera" unpack $at/big.tsr -o coarse.raw -l 3
sent "every eighth sample" 20000 1000000
check "the same" 0 "$tessera" unpack $at/big.tsr -o again.raw -l 3
cmp coarse.raw again.raw || fail "other samples from the cache"
sent "the same again" 160 1000
check "all" 0 "$tessera" verify $at/big.tsr
sent "all" $((big - 1200000)) $((big * 105 / 100))
[ "$most" -ge 2 ] || fail "one request after the other"
check "all again" 0 "$tessera" unpack $at/big.tsr -o again.raw
cmp big.raw again.raw || fail "other samples from the cache"
sent "all again" 160 1000

alike() { # two PNGs of 8 bits a channel; two runs may draw the last passes in another order, a few pixels differ by one
    python3 - "$@" <<'PY'
import struct, sys, zlib
def pixels(name):
    data, at, found = open(name, "rb").read(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", data[at + 8:at + 18])
        found += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    assert depth == 8
    step = {2: 3, 6: 4}[color]
    raw, row, rows = zlib.decompress(found), bytearray(width * step), []
    for y in range(height):
        begin = y * (width * step + 1)
        kind, above, row = raw[begin], row, bytearray(raw[begin + 1:begin + 1 + width * step])
        for x in range(len(row)):
            a, b = row[x - step] if x >= step else 0, above[x]
            c = above[x - step] if x >= step else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[x] = (row[x] + (0, a, b, (a + b) // 2, paeth)[kind]) % 256
        rows.append(row)
    return rows
one, two = (pixels(name) for name in sys.argv[1:])
apart = [abs(a - b) for r, s in zip(one, two, strict=True) for a, b in zip(r, s, strict=True)]
seen = len({bytes(row) for row in one})
print("pictures: mean difference", sum(apart) / len(apart), "largest", max(apart))
sys.exit(seen < 20 or sum(apart) / len(apart) > 0.1)
PY
}
forget
draw() { "$tessera" render "$1" --view volume --size ${size:-200x150} "${@:3}" -o "$2" > /dev/null 2> err; }
draw $at/big.tsr remote.png # by OpenGL, though there may be no graphics card: it needs no more than is seen
status=$?
[ $status = 3 ] && grep -q OpenGL err || {
    [ $status = 0 ] || die "render"
    sent "a small picture" 10000 $((big / 7)) # every second sample along each axis
    draw served/big.tsr local.png --set /render/engine=gl --set /data/lattice=grid || die "render, local"
    alike local.png remote.png || fail "another picture"
    # Nor is a volume that fits into one texture read as a whole.
    size=80x60 draw $at/middle.tsr middle.png || die "render middle"
    sent "a small picture of less" 10000 $((middle / 2))
    # A session that names the address, saved by a picture and opened again.
    check "session of the picture" 0 "$tessera" info remote.png --json
    say "\"$at/big.tsr\"" out.txt
    draw remote.png again.png || die "render the session"
    alike remote.png again.png || fail "the session draws another picture"
}

# The cache: damage is noticed and mended, and the limit holds.
check "fill" 0 "$tessera" verify $at/cell.tsr
told > /dev/null
python3 - <<'PY'
import glob
for name in glob.glob("cache/tessera/remote/*/*"):
    data = bytearray(open(name, "rb").read())
    data[len(data) // 2] ^= 1
    open(name, "wb").write(data)
PY
check "damaged cache" 0 "$tessera" unpack $at/cell.tsr -o again.raw
cmp remote.raw again.raw || fail "other samples from the damaged cache"
sent "mended" 1000 1000000
check "mended cache" 0 "$tessera" unpack $at/cell.tsr -o again.raw
sent "after that" 160 1000
check "a small cache" 0 "$tessera" verify $at/big.tsr --remote.cache 16
kept=$(du -sb --apparent-size cache/tessera/remote | cut -f1)
files=$(find cache/tessera/remote -type d | wc -l)
[ "$kept" -le $((16 * 1048576 + files * 4096)) ] || fail "the cache takes $kept bytes"
[ "$kept" -ge 8000000 ] || fail "the cache keeps only $kept bytes"
"$tessera" verify $at/big.tsr --remote.cache 16 > other.txt 2>&1 &
other=$!
check "two at once" 0 "$tessera" verify $at/big.tsr --remote.cache 16
wait $other || fail "the other one: $(cat other.txt)"
XDG_CACHE_HOME=/proc/nowhere check "no cache" 0 "$tessera" verify $at/cell.tsr

# Damage on the server is not mended, and named: verify does not ask the cache, which has the same archive whole.
cp served/cell.tsr served/bad.tsr
python3 -c 'f = open("served/bad.tsr", "r+b"); f.seek(3000); b = f.read(1); f.seek(3000); f.write(bytes([b[0] ^ 1]))'
check "all in the cache" 0 "$tessera" verify $at/cell.tsr
check "damaged file" 2 "$tessera" verify $at/bad.tsr
forget
way damage=2
check "wrong once" 0 "$tessera" verify $at/cell.tsr
forget

# Work that was killed does not go on with other data of the same address.
cp served/cell.tsr served/run.tsr
forget
way delay=0.3
"$tessera" pack $at/run.tsr -o shared.tsr --lattice cc --block-times 1 > out.txt 2>&1 &
packing=$!
for ((i = 0; i < 1000; ++i)); do [ -e shared.tsr.blocks/job.json ] && break; sleep 0.01; done
kill -KILL $packing && wait $packing
[ $? = 137 ] || fail "packing had ended before it was killed: $(cat out.txt)"
way delay=0
"$tessera" pack served/cell.tsr -o served/run.tsr --max-error 0.01 > /dev/null 2> err || die "pack"
check "other data of the same address" 2 "$tessera" pack $at/run.tsr -o shared.tsr --lattice cc --block-times 1
say "shared.tsr.blocks: belongs to other data or options" err.txt
cp served/cell.tsr served/run.tsr
check "the same data" 0 "$tessera" pack $at/run.tsr -o shared.tsr --lattice cc --block-times 1

# A network that fails for a while, and for good.
way busy=3
check "busy" 0 "$tessera" info $at/cell.tsr
way cut=2
check "cut off" 0 "$tessera" verify $at/cell.tsr
way busy=1000
check "busy for long" 2 "$tessera" info $at/cell.tsr --remote.patience 0.5
say "$at/cell.tsr: the server cannot answer now (HTTP 503); tried [2-9] times" err.txt
[ "$(wc -l < err.txt)" = 1 ] || fail "not one line"
way busy=0
check "nobody there" 2 "$tessera" info http://127.0.0.1:1/a.tsr --remote.patience 0.2
say "127.0.0.1:1/a.tsr: .*tried [2-9] times" err.txt
forget
check "no such file" 2 "$tessera" info $at/gone.tsr
say "$at/gone.tsr: no such file (HTTP 404)" err.txt
check "no archive" 2 "$tessera" info $at/../big.raw
way ranges=0
check "no ranges" 2 "$tessera" info $at/cell.tsr
say "gives no ranges" err.txt
way ranges=1
check "a password" 2 "$tessera" info http://me:secret@127.0.0.1/cell.tsr
say netrc err.txt
grep -q secret err.txt && fail "the password is printed"
way password=bWU6c2VjcmV0
check "without a password" 2 "$tessera" info $at/cell.tsr
say "access denied (HTTP 401)" err.txt
echo "machine 127.0.0.1 login me password secret" > .netrc
chmod 600 .netrc
check "with the password of .netrc" 0 "$tessera" info $at/cell.tsr
way password=
rm .netrc
check "several" 2 "$tessera" stats $at/cell.tsr $at/big.tsr
say "opened by itself" err.txt

# The default entry of .netrc is for every host, so for none that a file may name; nor does a password go to the host that
# an answer leads to.
printf 'default login me password secret\n' > .netrc
way password=bWU6c2VjcmV0
told > /dev/null
check "with the default entry" 2 "$tessera" info $at/cell.tsr
read -r bytes requests most logins <<< "$(told)"
[ "$requests" -ge 1 ] && [ "$logins" = 0 ] || fail "the default entry was sent in $logins of $requests requests"
way password=
printf 'machine localhost login me password secret\n' > .netrc
way "elsewhere=$at/big.tsr"
told > /dev/null
check "a password for one host" 0 "$tessera" info http://localhost:$port/elsewhere.tsr
read -r bytes requests most logins <<< "$(told)"
[ "$logins" -ge 1 ] && [ $((2 * logins)) -le "$requests" ] || fail "$logins of $requests requests had the password"
way elsewhere=/big.tsr
rm .netrc

# Answers without an end: what was not asked for is not read to it, and what comes too slowly is given up.
forget
for endless in 1 2 3; do
    way endless=$endless
    name=cell.tsr status=2
    [ $endless = 2 ] && name=elsewhere.tsr status=0 # what it leads to is read
    check "an answer without end, $endless" $status timeout 60 "$tessera" info $at/$name --remote.patience 0
    [ "$(wc -l < err.txt)" -le 1 ] || fail "not one line"
    read -r bytes requests most logins <<< "$(told)"
    echo "an answer without end, $endless: $bytes bytes sent"
    [ "$bytes" -le 20000000 ] || fail "$bytes bytes were taken of it"
done
way endless=4
check "a head that creeps" 2 timeout 60 "$tessera" info $at/cell.tsr --remote.patience 0
[ "$(wc -l < err.txt)" = 1 ] || fail "not one line"
way endless=0

# A session that somebody sent names a machine: it is not asked before the user allows it.
python3 - "$source" "$at" "$work" <<'PY'
import json, sys
source, at, work = sys.argv[1:]
session = json.load(open(source + "/tests/sessions/portable.tessera.json"))
session["app"] = "tessera"
for key in ("history", "dock"):
    session.pop(key, None)
def write(name, address, change=lambda data: None):
    file = {"absolutePath": address, "path": address, "bytes": 1, "hash": ""}
    session["data"]["files"] = [file]
    change(session["data"])
    json.dump(session, open(name, "w"))
    session["data"].pop("other", None)
write("sent.tessera.json", at + "/cell.tsr")
write("ssh.tessera.json", "sftp://me@cluster:2022" + work + "/served/cell.tsr")
write("command.tessera.json", "sftp://-oProxyCommand=touch${IFS}owned/x.tsr")
def other(data):
    data["files"] = [{"absolutePath": work + "/served/cell.tsr", "path": work + "/served/cell.tsr", "bytes": 1, "hash": ""}]
    data["other"] = {"files": [{"absolutePath": at + "/cell.tsr", "path": at + "/cell.tsr", "bytes": 1, "hash": ""}]}
write("other.tessera.json", "", other)
session.pop("app")
write("layout.tessera.json", at + "/cell.tsr")
PY
mkdir -p bin
printf '#!/bin/sh\nexec python3 "%s" "$@"\n' "$source/tests/e2e/fake_ssh.py" > bin/ssh
chmod +x bin/ssh
export FAKE_SSH_LOG=$work/ssh.log
rm -rf state/tessera/machines.json cache
told > /dev/null
picture() { env PATH="$work/bin:$PATH" "$tessera" render "$@" --view volume --size 64x48 -o sent.png; }
for session in sent other layout ssh; do
    check "$session: a session that names a machine" 2 picture $session.tessera.json
    say "is named by a file, and nobody has allowed to ask it; --allow-remote" err.txt
    [ "$(wc -l < err.txt)" = 1 ] || fail "not one line"
done
check "data of it in another layout" 2 picture sent.tessera.json --layout overview
check "each time of it" 2 "$tessera" replay sent.tessera.json --animation -o replayed
check "a host that is an option" 2 picture command.tessera.json --allow-remote
say "the address has no valid host" err.txt
[ ! -e owned ] || fail "a host was taken for an option of ssh"
read -r bytes requests most logins <<< "$(told)"
[ "$requests" = 0 ] || fail "$requests requests before the user allowed any"
[ ! -e ssh.log ] || fail "ssh was started before the user allowed it"
picture sent.tessera.json --allow-remote > out.txt 2> err.txt # it may lack OpenGL
read -r bytes requests most logins <<< "$(told)"
[ "$requests" -ge 1 ] || fail "allowed, it is not asked: $(cat err.txt)"
picture ssh.tessera.json --allow-remote > out.txt 2> err.txt
[ -e ssh.log ] || fail "allowed, ssh is not started: $(cat err.txt)"
rm -f ssh.log
check "allowed once" 2 picture sent.tessera.json
check "the user himself" 0 "$tessera" info $at/cell.tsr
rm -rf cache
told > /dev/null
picture sent.tessera.json > out.txt 2> err.txt
read -r bytes requests most logins <<< "$(told)"
[ "$requests" -ge 1 ] || fail "a machine that the user has asked himself is not known: $(cat err.txt)"

# https, with a certificate that is trusted only where it is named; there is one where openssl could make it.
if [ -n "$secure" ]; then
    check "not trusted" 2 "$tessera" info https://localhost:$secure/cell.tsr
    say "https://localhost:$secure/cell.tsr: .*certificate" err.txt
    [ "$(wc -l < err.txt)" = 1 ] || fail "not one line"
    "$tessera" info $at/cell.tsr > local.txt
    for variable in SSL_CERT_FILE CURL_CA_BUNDLE; do
        check "info by https" 0 env $variable=certificate.pem "$tessera" info https://localhost:$secure/cell.tsr
        cmp <(sed "s#$at#https://localhost:$secure#g" local.txt) out.txt || fail "info by https differs"
    done
    check "verify by https" 0 env SSL_CERT_FILE=certificate.pem "$tessera" verify https://localhost:$secure/middle.tsr
    check "another name" 2 env SSL_CERT_FILE=certificate.pem "$tessera" info https://127.0.0.1:$secure/cell.tsr
else
    echo "not tried: https, since openssl makes no certificate: $(tail -n 1 err)"
fi

# A slow line: 20 Mbit/s, an answer after 50 ms.
forget
way "delay=0.05&rate=2500000"
check "by a slow line" 0 "$tessera" unpack $at/middle.tsr -o slow.raw -l 1
"$tessera" unpack served/middle.tsr -o local.raw -l 1 2> err
cmp local.raw slow.raw || fail "other samples by a slow line"
way "delay=0&rate=0"

# The coarsest level of parameters with parts and of labels is read alone, from the first bytes of each brick.
forget
python3 - <<'PY'
import random
noise, half = random.Random(2).randbytes(128**3), bytes(x // 64 for x in range(128))
open("parts.raw", "wb").write(noise + half * 128**2)
PY
echo '{"dims": [128, 128, 128], "dtype": "uint8", "components": [{"name": "a"}, {"name": "half"}]}' > parts.json
"$tessera" pack parts.json -o served/parts.tsr --lattice cc --brick-size 64 --label half:0=left,1=right \
    --parts 'a=half:0|1' > /dev/null 2> err || die "pack parts"
"$tessera" info served/parts.tsr | grep -q "2 parts by half" || fail "no parts"
check "coarse parts" 0 "$tessera" unpack $at/parts.tsr -o coarse.raw -l 4
sent "every sixteenth sample of parts" 10000 $(($(stat -c %s served/parts.tsr) / 4))

# A file that is replaced while it is read: seen to be another one, not said to be damaged.
forget
"$tessera" generate fuel-cell -o new.tsr --size 19x21x20 --times 3 > /dev/null 2>&1
way delay=1
"$tessera" verify $at/cell.tsr > out.txt 2> err.txt &
reader=$!
asked=0
for ((i = 0; i < 100 && asked < 3; ++i)); do # twice for the headers, which are answered, and for the rest
    read -r bytes requests most logins <<< "$(told)"
    asked=$((asked + requests))
    sleep 0.1
done
mv new.tsr served/cell.tsr
wait $reader
[ $? = 2 ] || fail "read from a file that was replaced"
say "cell.tsr: the file has changed since it was opened" err.txt
[ "$(wc -l < err.txt)" = 1 ] || fail "not one line"
way delay=0
same "info of the new one" cell.tsr info FILE

# sftp, by a program that stands for ssh.
ssh_at=sftp://me@cluster:2022$work/served
fake() { env PATH="$work/bin:$PATH" "$@"; }
forget
check "info, sftp" 0 fake "$tessera" info $ssh_at/cell.tsr
check "info, local" 0 "$tessera" info served/cell.tsr
"$tessera" info served/cell.tsr > local.txt
fake "$tessera" info $ssh_at/cell.tsr > out.txt
cmp local.txt out.txt || fail "info by sftp differs"
say "-p 2022 -l me -s cluster sftp" ssh.log
say "BatchMode=yes" ssh.log
check "verify, sftp" 0 fake "$tessera" verify $ssh_at/big.tsr
rm -rf cache
check "short answers" 0 env FAKE_SSH_MOST=1000 PATH="$work/bin:$PATH" "$tessera" verify $ssh_at/cell.tsr
check "no such file" 2 fake "$tessera" info $ssh_at/gone.tsr
say "no such file" err.txt
check "unknown host" 2 env FAKE_SSH_SAYS="Host key verification failed." PATH="$work/bin:$PATH" "$tessera" info $ssh_at/cell.tsr
say 'run "ssh -p 2022 me@cluster" in a terminal and compare the fingerprint' err.txt
check "not let in" 2 env FAKE_SSH_SAYS="me@cluster: Permission denied (publickey)." PATH="$work/bin:$PATH" "$tessera" info $ssh_at/cell.tsr
say "ssh-add" err.txt

# sftp by ssh itself, where sshd is installed (or named), by a name of its configuration.
sshd=${TESSERA_SSHD:-$(PATH=$PATH:/usr/sbin command -v sshd)}
if [ -z "$sshd" ]; then
    echo "not tried: sftp by ssh itself, since no sshd is installed"
    finish
fi
for key in host mine; do ssh-keygen -q -t ed25519 -N "" -f $key || die "ssh-keygen"; done
free=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
cat > sshd.conf <<CONF
ListenAddress 127.0.0.1:$free
HostKey $work/host
AuthorizedKeysFile $work/mine.pub
StrictModes no
UsePAM no
PidFile none
PermitRootLogin yes
Subsystem sftp internal-sftp
CONF
cat > ssh.conf <<CONF
Host somewhere
    HostName 127.0.0.1
    Port $free
    User $(id -un)
    IdentityFile $work/mine
    IdentitiesOnly yes
    UserKnownHostsFile $work/known
    GlobalKnownHostsFile none
CONF
printf '#!/bin/sh\nexec %s -F "%s" "$@"\n' "$(command -v ssh)" "$work/ssh.conf" > bin/ssh
echo "sftp by ssh itself, with $sshd"
: > sshd.log
"$sshd" -D -e -f sshd.conf 2> sshd.log &
trap 'kill $server $!; rm -rf "$work"' EXIT
for ((i = 0; i < 50; ++i)); do grep -q "Server listening" sshd.log && break; sleep 0.1; done
grep -q "Server listening" sshd.log || { # as where no service has made its folder /run/sshd
    echo "not tried: sftp by ssh itself, since sshd does not start: $(tail -n 1 sshd.log)"
    finish
}
rm -rf cache
check "unknown host" 2 fake "$tessera" info sftp://somewhere$work/served/cell.tsr
say 'run "ssh somewhere" in a terminal' err.txt
echo "[127.0.0.1]:$free $(cat host.pub)" > known
check "info by ssh" 0 fake "$tessera" info sftp://somewhere$work/served/cell.tsr
cmp local.txt out.txt || fail "info by ssh differs"
check "verify by ssh" 0 fake "$tessera" verify sftp://somewhere$work/served/big.tsr
check "no such file" 2 fake "$tessera" info sftp://somewhere$work/served/gone.tsr
say "no such file" err.txt
rm mine
check "not let in" 2 fake "$tessera" info sftp://somewhere$work/served/cell.tsr
say "ssh-add" err.txt
finish
