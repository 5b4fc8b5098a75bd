#!/bin/bash
# `tessera pack --follow`: an archive is made while a solver writes its files, slowly and in part; the program is killed at
# random moments and started again; in the end the archive holds what packing all files at once gives.
# Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$source/tests/e2e/common.bash"
has_importer() { [ -x "$(dirname "$tessera")/tessera-import" ]; }
trap 'kill $(jobs -p) 2> /dev/null; rm -rf "$work"' EXIT

times=12
"$tessera" generate fuel-cell --even -o cell.tsr --size 9x11x24 --times $times > /dev/null || die "generate"
mkdir whole
"$tessera" info cell.tsr --json | python3 -c 'import json, sys; print(*json.load(sys.stdin)["times"])' > times
number=0
for time in $(cat times); do # a raw file has one time and a sidecar; numbers of one and of two digits
    "$tessera" unpack cell.tsr -o whole/run_$number.raw -t "$time" > /dev/null || die "unpack"
    number=$((number + 1))
done
python3 - whole/run_*.json << 'END' || die "sidecars"
import json, sys
for name in sys.argv[1:]:
    about = json.load(open(name))
    del about["times"]
    json.dump(about, open(name, "w"))
END
[ $number = $times ] || die "not $times times"

same() { # same ARCHIVE ARCHIVE: intact, of the same times, and every sample the same
    local each
    for each in "$@"; do
        "$tessera" verify "$each" > /dev/null || fail "verify $each"
        "$tessera" unpack "$each" -o "$each.raw" > /dev/null || fail "unpack $each"
        "$tessera" info "$each" --json > "$each.info"
    done
    cmp "$1.raw" "$2.raw" || fail "$1 and $2 have other samples"
    python3 - "$1.info" "$2.info" << 'END' || fail "$1 and $2 tell another story"
import json, sys
a, b = (json.load(open(name)) for name in sys.argv[1:])
for key in ("name", "size", "times", "timeName", "timeUnit", "parameters", "spacing", "origin"):
    x, y = a.get(key), b.get(key)
    if key == "parameters":  # which the ranges over all times are part of
        for p in x + y: p.pop("resampled", None)
    assert x == y, (key, x, y)
END
}

# follow_and_kill KIND OPTIONS...: the solver writes run_*.KIND while the follower is killed and started again.
follow_and_kill() {
    local kind=$1 kills=0 pid solver
    shift
    rm -rf out live.tsr
    mkdir out
    python3 "$source/tests/e2e/solver.py" out "$kind_seed" $order &
    solver=$!
    : > lines
    start() {
        "$tessera" pack --follow "out/run_*.$kind" -o live.tsr --settle 0.1 --until-idle 2 "$@" >> lines 2> err &
        pid=$!
    }
    while [ $kills -lt 12 ] && kill -0 $solver 2> /dev/null; do
        start "$@"
        sleep "0.$((RANDOM % 10))$((RANDOM % 10))"
        kill -KILL $pid 2> /dev/null && kills=$((kills + 1))
        wait $pid 2> /dev/null
        [ ! -e live.tsr ] || "$tessera" verify live.tsr > /dev/null || fail "a kill left a damaged archive"
    done
    if ! grep -q appended lines; then # a busy machine: every kill came before the first time was there
        start "$@"
        for i in $(seq 600); do grep -q appended lines && break; sleep 0.1; done
        kill -KILL $pid 2> /dev/null && kills=$((kills + 1))
        wait $pid 2> /dev/null
    fi
    start "$@"
    wait $pid || { fail "follow $kind $*"; cat err; }
    wait $solver
    echo "$kind $*: killed $kills times"
    [ $kills -ge 3 ] || fail "killed $kills times only"
    say "continues after time" lines
    check "pack at once" 0 "$tessera" pack whole/run_*."$kind" -o once.tsr "$@"
    same live.tsr once.tsr
    # Each time is said once; a kill may come between a time and its line.
    [ "$(grep -c appended lines)" -le $times ] || fail "a time was said twice"
    [ -z "$(grep appended lines | sed 's/.*time \([^ ]*\) of.*/\1/' | sort | uniq -d)" ] || fail "a time was said twice"
    ls live.tsr.part-* 2> /dev/null && fail "a part is left"
}

order=$(for i in $(seq 0 $((times - 1))); do [ $((i % 2)) = 0 ] && echo whole/run_$i.raw whole/run_$i.json ||
    echo whole/run_$i.json whole/run_$i.raw; done)
# Jumps that the first time does not show yet are stated.
parts=(--parts 'p=region:1,2|4,5' --parts 'H2O=region:1,2|4,5')
kind_seed=1 follow_and_kill raw --lattice cc "${parts[@]}"
kind_seed=2 follow_and_kill raw "${parts[@]}"

# Without a kill: a line for each time, in order; then SIGTERM ends it, with what it has.
mkdir slow
cp whole/run_[0-4].* slow
"$tessera" pack --follow 'slow/run_*.raw' -o slow.tsr --settle 0.1 --lattice cc > lines 2> err &
pid=$!
for i in $(seq 100); do [ "$(grep -c appended lines)" = 5 ] && break; sleep 0.1; done
cp whole/run_5.* slow
for i in $(seq 100); do [ "$(grep -c appended lines)" = 6 ] && break; sleep 0.1; done
kill -TERM $pid
wait $pid
[ $? = 0 ] || fail "SIGTERM: a status other than 0"
sed 's/.*time \([^ ]*\) of \([^ ]*\) appended (\([0-9]*\) time.*/\1 \2 \3/' lines > said
for i in 0 1 2 3 4 5; do echo "$i run_$i.raw $((i + 1))"; done | cmp - said || fail "other lines: $(cat lines)"
check "what was there" 0 "$tessera" pack whole/run_[0-5].raw -o six.tsr --lattice cc
same slow.tsr six.tsr

# The same command again appends nothing twice; as JSON.
cp whole/run_6.* slow
check "again" 0 "$tessera" pack --follow 'slow/run_*.raw' -o slow.tsr --settle 0.1 --until-idle 0.5 --lattice cc --json
python3 -c 'import json; l=[json.loads(x) for x in open("out.txt")]; assert len(l)==1 and l[0]["time"]==6 and l[0]["times"]==7 and l[0]["file"]=="slow/run_6.raw", l' ||
    fail "$(cat out.txt)"
check "with other options" 2 "$tessera" pack --follow 'slow/run_*.raw' -o slow.tsr --until-idle 0.5 --lattice bcc
say "other options" err.txt

# A file that cannot be read is waited for, then said and left out, and the exit status tells.
head -c 1000 whole/run_7.raw > slow/run_7.raw
cp whole/run_7.json slow
cp whole/run_8.* slow
check "a broken file" 2 "$tessera" pack --follow 'slow/run_*.raw' -o slow.tsr --settle 0.1 --retry 0.5 --until-idle 0.5 \
    --lattice cc
say "run_7.raw: cannot be read (.*): it is left out" err.txt
say "time 8 of run_8.raw appended (8 times" out.txt
check "it is valid" 0 "$tessera" verify slow.tsr

# What cannot be followed.
mkdir two
cp whole/run_1.* two
for end in raw json; do cp whole/run_1.$end two/run_b_1.$end; done
bad() { # bad TEXT OPTIONS...
    local text=$1
    shift
    check "$*" 2 "$tessera" pack "$@" --until-idle 0.2 --settle 0
    say "$text" err.txt
}
bad "in quotes" --follow slow/run_1.raw -o no.tsr
bad "in quotes" --follow slow/run_*.raw -o no.tsr
bad "D4" --follow 'slow/run_*.raw' -o no.tsr --lattice d4
bad "size of a series" --follow 'slow/run_*.raw' -o no.tsr --target-size 1
bad "importance" --follow 'slow/run_*.raw' -o no.tsr --discard 0.1
bad "two series" --follow 'two/run_*.raw' -o no.tsr
bad "no file fits" --follow 'none/run_*.raw' -o no.tsr
bad "holds the series run" --follow 'two/run_b*.raw' -o slow.tsr --lattice cc
check "without --follow" 1 "$tessera" pack slow/run_1.raw -o no.tsr --until-idle 1
[ ! -e no.tsr ] || fail "an archive where nothing could be followed"

# Through tessera-import, of files that state their times.
if has_importer; then
    mkdir vti
    number=0
    for time in $(cat times); do
        "$tessera" unpack cell.tsr -o whole/run_$number.vti -t "$time" > /dev/null || die "unpack to .vti"
        number=$((number + 1))
    done
    order=$(for i in $(seq 0 $((times - 1))); do echo whole/run_$i.vti; done)
    kind_seed=3 follow_and_kill vti --lattice cc "${parts[@]}"

    # Ctrl-C on a terminal interrupts the reader as well: the file that is being appended is finished nevertheless.
    printf '#!/bin/bash\n: > begun\nsleep 1\nexec "%s" "$@"\n' "$(dirname "$tessera")/tessera-import" > slow-import
    chmod +x slow-import
    python3 - "$tessera" << 'END' || fail "Ctrl-C"
import os, signal, subprocess, sys, time
run = subprocess.Popen([sys.argv[1], "pack", "--follow", "whole/run_*.vti", "-o", "stopped.tsr", "--settle", "0"],
                       env={**os.environ, "TESSERA_IMPORT": os.getcwd() + "/slow-import"}, start_new_session=True,
                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
while not os.path.exists("begun"): time.sleep(0.01)
os.killpg(run.pid, signal.SIGINT)
said = run.communicate(timeout=60)[0]
assert run.returncode == 0 and said.count("appended") == 1, (run.returncode, said)
END
    check "verify what Ctrl-C left" 0 "$tessera" verify stopped.tsr
fi
finish
