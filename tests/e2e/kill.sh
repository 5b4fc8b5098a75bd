#!/bin/bash
# kill -9 at random moments of pack, append and convert: what was there before is still there, or the new archive is whole.
# KILLS: how many for each of them (8). Arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"
kills=${KILLS:-6}

"$tessera" generate fuel-cell --even -o all.raw --size 17x21x48 --times 5 > /dev/null || die "generate"
cp all.raw later.raw
python3 -c 'import json; about = json.load(open("all.json")); about["times"] = [time + 1000 for time in about["times"]]
json.dump(about, open("later.json", "w"))'
options=(--lattice cc --lossless)
"$tessera" pack all.raw -o all.tsr "${options[@]}" > /dev/null || die "pack"
"$tessera" pack all.raw -o coarse.tsr --max-error 0.01 > /dev/null || die "pack with a bound"
cp all.tsr both.tsr
"$tessera" pack later.raw -o both.tsr --append > /dev/null || die "append"
"$tessera" convert coarse.tsr -o converted.tsr --lattice cc > /dev/null || die "convert"

times_of() { "$tessera" info "$1" --json | python3 -c 'import json, sys; print(len(json.load(sys.stdin)["times"]))'; }
same_as() { # same_as FILE FILE...: the first is one of the others
    local each
    for each in "${@:2}"; do cmp -s "$1" "$each" && return 0; done
    return 1
}

# interrupt WHAT OUT BEFORE COMMAND...: `before` puts OUT as it was; the program runs as long as it takes at most.
interrupt() {
    local what=$1 out=$2 before=$3 pid begin most killed=0
    shift 3
    $before
    begin=$(date +%s%N)
    "$@" > /dev/null 2>&1 || die "$what"
    most=$((($(date +%s%N) - begin) / 1000000 + 1))
    for _ in $(seq "$kills"); do
        $before
        "$@" > /dev/null 2>&1 &
        pid=$!
        sleep "$(printf '0.%03d' $((RANDOM % most % 1000)))"
        kill -KILL $pid 2> /dev/null && killed=$((killed + 1))
        wait $pid 2> /dev/null
        [ ! -e "$out" ] || "$tessera" verify "$out" > /dev/null || fail "$what: a kill left a damaged archive"
        after_"$what" || fail "$what: a kill left something else"
    done
    $before
    "$@" > /dev/null 2>&1 || fail "$what after kills"
    ls "$out".part-* > /dev/null 2>&1 && fail "$what: parts of killed programs stay: $(ls "$out".part-*)"
    echo "$what: killed $killed of $kills times"
    [ $killed -ge $((kills / 3)) ] || fail "$what: killed $killed times only"
}

nothing() { rm -f new.tsr; }
after_new() { [ ! -e new.tsr ] || [ "$(times_of new.tsr)" -ge 1 ]; }
interrupt new new.tsr nothing "$tessera" pack all.raw -o new.tsr "${options[@]}"
cmp -s new.tsr all.tsr || fail "new: another archive than without kills"

old() { cp coarse.tsr over.tsr; }
after_over() { same_as over.tsr coarse.tsr all.tsr; }
interrupt over over.tsr old "$tessera" pack all.raw -o over.tsr "${options[@]}"

first() { cp all.tsr grown.tsr; }
after_append() { [ "$(times_of grown.tsr)" -ge 5 ]; }
interrupt append grown.tsr first "$tessera" pack later.raw -o grown.tsr --append
cmp -s grown.tsr both.tsr || fail "append: another archive than without kills"
# And on from where a kill left it, without starting again.
first
for _ in $(seq "$kills"); do
    "$tessera" pack later.raw -o grown.tsr --append > /dev/null 2>&1 &
    sleep "0.0$((RANDOM % 10))"
    kill -KILL $! 2> /dev/null
    wait $! 2> /dev/null
    "$tessera" verify grown.tsr > /dev/null || fail "append: a kill left a damaged archive"
done

converted() { cp coarse.tsr again.tsr; }
after_convert() { same_as again.tsr coarse.tsr converted.tsr; }
interrupt convert again.tsr converted "$tessera" convert coarse.tsr -o again.tsr --lattice cc
finish
