#!/bin/bash
# generate as a user runs it: arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"

check "an archive" 0 "$tessera" generate fuel-cell -o cell.tsr --size 7x13x20 --times 3
check "which is whole" 0 "$tessera" verify cell.tsr
check "info" 0 "$tessera" info cell.tsr
for name in O2 H2 H2O p T U region "cathode GDL" "mol/m3"; do
    grep -q -- "$name" out.txt || fail "info says nothing of $name"
done

# Three times as .vti: numbered files and a series; once: a single file.
check "a series" 0 "$tessera" generate fuel-cell --even -o cell.vti --size 7x13x20 --times 3
for file in cell_0000.vti cell_0001.vti cell_0002.vti cell.pvd; do [ -s $file ] || fail "no $file"; done
check "one time" 0 "$tessera" generate fuel-cell --even -o one.vti --size 7x13x20 --times 1
[ -s one.vti ] || fail "no one.vti"

# Packed as CC without loss and unpacked, the raw samples are those generated.
check "raw" 0 "$tessera" generate fuel-cell --even -o direct.raw --size 7x13x20 --times 2
check "lossless on CC" 0 "$tessera" generate fuel-cell --even -o cc.tsr --size 7x13x20 --times 2 --lattice cc --lossless
check "unpack" 0 "$tessera" unpack cc.tsr -o back.raw
cmp direct.raw back.raw || fail "the way through an archive changed samples"

check "marschner-lobb" 0 "$tessera" generate marschner-lobb -o ml.tsr --size 17x9x5 --times 2 --set fM=4
check "its list" 0 "$tessera" generate marschner-lobb --list
grep -q fM out.txt || fail "the list has no fM"

# Axes of uneven spacing: through an archive the samples and the planes stay what they are.
check "membrane" 0 "$tessera" generate membrane -o m.tsr --size 6x4x20
check "which is whole, too" 0 "$tessera" verify m.tsr
check "what it is" 0 "$tessera" info m.tsr
grep -q "spacing    x [0-9.]* to [0-9.]* mm, y 250 um, z [0-9.]* to [0-9.]* um" out.txt || fail "no spacing: $(cat out.txt)"
check "its list" 0 "$tessera" generate membrane --list
grep -q heatFlux out.txt || fail "the list has no heatFlux"
check "as raw" 0 "$tessera" generate membrane -o direct.raw --size 6x4x20
check "and from the archive" 0 "$tessera" unpack m.tsr -o back.raw
cmp direct.raw back.raw && cmp <(sed 's/direct/back/' direct.json) back.json || fail "the archive changed the layers"
check "as .vtr" 0 "$tessera" generate membrane -o direct.vtr --size 6x4x20
check "from the archive" 0 "$tessera" unpack m.tsr -o back.vtr
cmp direct.vtr back.vtr || fail "the archive changed the rectilinear grid"
check "packed from raw" 0 "$tessera" pack direct.raw -o raw.tsr
check "and unpacked" 0 "$tessera" unpack raw.tsr -o again.raw
cmp direct.raw again.raw || fail "packing changed samples"
check "no image" 2 "$tessera" generate membrane -o bad.vti --size 6x4x20
say "write .vtr" err.txt

# What is wrong is said, and nothing is left.
check "no such model" 1 "$tessera" generate frog -o bad.tsr
check "a size that is none" 1 "$tessera" generate fuel-cell -o bad.tsr --size 7x13
check "a setting that is none" 1 "$tessera" generate fuel-cell -o bad.tsr --set nx
check "no output" 1 "$tessera" generate fuel-cell
check "an unknown setting" 2 "$tessera" generate fuel-cell -o bad.tsr --set volts=3
check "out of range" 2 "$tessera" generate fuel-cell -o bad.tsr --size 7x13x2000
check "an unknown ending" 2 "$tessera" generate fuel-cell -o bad.xyz
check "a folder that is not there" 3 "$tessera" generate fuel-cell -o missing/bad.tsr --size 5x7x8 --times 1
ls | grep -q bad && fail "something of a bad run is left"

# Ctrl-C. A background job of a script ignores SIGINT, so that python sends it.
python3 - "$tessera" <<'EOF' || failures=$((failures + 1))
import os, signal, subprocess, sys, time
run = subprocess.Popen([sys.argv[1], "generate", "fuel-cell", "-o", "stopped.tsr", "--size", "33x39x200"],
                       stderr=subprocess.PIPE, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
def listens(): # has it a handler for SIGINT (the second bit)?
    caught = [line.split()[1] for line in open("/proc/%d/status" % run.pid) if line.startswith("SigCgt")]
    return caught and int(caught[0], 16) & 2
while run.poll() is None and not listens(): time.sleep(0.01)
time.sleep(0.5)
run.send_signal(signal.SIGINT)
code = run.wait(timeout=60)
left = [name for name in os.listdir(".") if name.startswith("stopped")]
if code != 130 or left:
    sys.exit("FAILED: interrupted generate ended with %d and left %s" % (code, left))
EOF

finish
