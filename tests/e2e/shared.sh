#!/bin/bash
# Commands whose work processes of mpirun and srun share: arguments TESSERA SOURCE_DIR.
# shellcheck disable=SC2046
tessera=$1
source "$2/tests/e2e/common.bash"
"$tessera" generate fuel-cell -o cell.tsr --size 7x13x20 --times 9 >/dev/null 2>err || die "make data"

together() { # together COUNT COMMAND...: by so many processes; what they say is in rank*.txt
    local count=$1
    shift
    ranks 0 $RANDOM "$count" "$tessera" "$@"
    [ -z "$(ls -d ./*.blocks 2>/dev/null)" ] || fail "$*: $(ls -d ./*.blocks) is left"
}
shares() { # shares TOTAL WHAT: each process has said how much it did, in all TOTAL
    [ "$(awk "/^[0-9]+ of $1 $2 by process/ { sum += \$1 } END { print sum }" rank*.txt)" = "$1" ] ||
        fail "not $1 $2 are shared: $(cat rank*.txt)"
}

for what in "--of O2,T" "--balance O2" "--along z --of T"; do
    for ending in csv json svg; do
        [ "$what $ending" = "--along z --of T svg" ] && continue # a figure shows one time
        # shellcheck disable=SC2086
        check "stats $what" 0 "$tessera" stats cell.tsr --all-times $what -o one.$ending
        # shellcheck disable=SC2086
        together 3 stats cell.tsr --all-times $what -o three.$ending
        shares 9 "times computed"
        cmp one.$ending three.$ending || fail "three processes give other statistics: $what, .$ending"
    done
done

check "surfaces" 0 "$tessera" mesh cell.tsr --channel T --iso 353.4 --color-by O2 --all-times -o iso.vtp
grep -q 'timestep="0.03" .*file="iso_0001.vtp"' iso.pvd || fail "iso.pvd: $(cat iso.pvd)"
[ "$(grep -c '^iso_000[0-8].vtp: [0-9]* vertices' out.txt)" = 9 ] || fail "mesh says $(cat out.txt)"
mkdir shared && together 2 mesh cell.tsr --channel T --iso 353.4 --color-by O2 --all-times -o shared/iso.vtp
shares 9 surfaces
for file in iso_000{0..8}.vtp iso.pvd; do cmp $file shared/$file || fail "$file differs"; done
[ "$(ls shared | wc -l)" = 10 ] || fail "surfaces: $(ls shared)"
check "the third of them" 0 "$tessera" mesh cell.tsr --channel T --iso 353.4 --color-by O2 --time 0.06 -o third.vtp
cmp third.vtp iso_0002.vtp || fail "the surface of a time differs from that among all"
check "surfaces that are not there" 2 "$tessera" mesh cell.tsr --channel T --iso 9000 --all-times -o none.ply
[ -z "$(ls none* 2>/dev/null)" ] || fail "empty surfaces are left"
cp iso.pvd kept.pvd
check "no surface at any time leaves what was there" 2 "$tessera" mesh cell.tsr --channel T --iso 9000 --all-times -o iso.vtp
for i in {0..8}; do cmp iso_000$i.vtp shared/iso_000$i.vtp || fail "iso_000$i.vtp was taken"; done
cmp kept.pvd iso.pvd || fail "iso.pvd was taken"
for i in 0 1; do # every process says that there is none
    env $(as empty $i 2) "$tessera" mesh cell.tsr --channel T --iso 9000 --all-times -o none.ply >/dev/null 2>rank$i.txt &
    children[i]=$!
done
for i in 0 1; do wait ${children[i]} && fail "process $i is content without a surface"; done
say "the surface is empty" rank0.txt
say "the surface is empty" rank1.txt
check "a surface at some times only" 0 "$tessera" mesh cell.tsr --channel T --iso 354.5 --all-times -o some.vtp
grep -q '^some_0000.vtp: 0 vertices' out.txt || fail "there is a surface at the first time: $(cat out.txt)"
[ "$(ls some_000{0..8}.vtp | wc -l)" = 9 ] || fail "not a file for each time"
check "a time and all times" 2 "$tessera" mesh cell.tsr --channel T --iso 353.4 --all-times --time 0 -o none.ply

picture=(--size 160x120 --set /render/samples=1)
variants=(--variant "as it is:" --variant "/render/filter=average")
check "figures" 0 "$tessera" compare cell.tsr "${picture[@]}" "${variants[@]}" --all-times -o figure.png --csv table.csv
[ "$(ls figure_000{0..8}.png | wc -l)" = 9 ] || fail "figures: $(ls figure*)"
together 2 compare cell.tsr "${picture[@]}" "${variants[@]}" --all-times -o shared/figure.png --csv shared/table.csv
shares 9 "figures drawn"
check "the eighth of them" 0 "$tessera" compare cell.tsr "${picture[@]}" "${variants[@]}" --time 0.21 -o eighth.png --csv eighth.csv
python3 - <<'EOF2' || fail "the tables differ"
import csv
def rows(name): # but for how long a picture took
    return [{k: v for k, v in row.items() if k != "ms per picture"} for row in csv.DictReader(open(name))]
alone, shared, eighth = rows("table.csv"), rows("shared/table.csv"), rows("eighth.csv")
assert alone == shared and len(alone) == 18, alone
assert len({row["RMSE (of 255)"] for row in alone}) > 2, alone
assert sorted({float(row["time [s]"]) for row in alone}) == [0, .03, .06, .09, .12, .15, .18, .21, .24], alone
assert [{k: v for k, v in row.items() if k != "time [s]"} for row in alone[14:16]] == eighth, eighth
EOF2

check "pictures" 0 "$tessera" replay cell.tsr --animation --view volume "${picture[@]}" -o drawn
together 2 replay cell.tsr --animation --view volume "${picture[@]}" -o both/
shares 9 "pictures drawn"
for i in {0..8}; do cmp drawn/frame-000$i.png both/frame-000$i.png || fail "frame $i differs"; done
# A folder that does not exist is said at once, by each process.
for command in "stats cell.tsr --all-times -o nowhere/x.csv" "mesh cell.tsr --channel T --iso 353.4 --all-times -o nowhere/x.ply"; do
    # shellcheck disable=SC2086
    check "$command" 3 timeout 20 env $(as nowhere 1 2) "$tessera" $command
    say "no such folder" err.txt
done
# What is wrong with the options leaves nothing behind.
together_fails() {
    ranks 2 wrong 2 "$tessera" "$@"
    [ -z "$(ls -d ./*.blocks 2>/dev/null)" ] || fail "$*: $(ls -d ./*.blocks) is left"
}
together_fails stats cell.tsr --all-times --balance O2 --velocity nothing -o wrong.csv
check "the right options" 0 "$tessera" stats cell.tsr --all-times --balance O2 -o wrong.csv
# JSON on standard output is that alone, in one of the processes.
together 2 stats cell.tsr --all-times --of T --json -o json.csv
cat rank0.txt rank1.txt | python3 -c 'import json, sys; assert json.load(sys.stdin)["kind"] == "statistics"' || fail "JSON: $(tail -3 rank?.txt)"
# Names of files need not be UTF-8.
cp cell.tsr $'caf\xe9.tsr'
check "statistics of such a file" 0 "$tessera" stats $'caf\xe9.tsr' --all-times --of T
check "surfaces of such a file" 0 "$tessera" mesh $'caf\xe9.tsr' --channel T --iso 353.4 --all-times -o cafe.ply
# Where each process has work of its own.
for rank in 0 1; do
    check "alone beside others" 0 env $(as own $rank 2) "$tessera" replay cell.tsr --animation --view volume "${picture[@]}" \
        --alone -o own$rank
    [ "$(ls own$rank | wc -l)" = 9 ] || fail "process $rank alone draws $(ls own$rank)"
done
# One that dies leaves its work to the next run, which draws only what is missing.
large=(--view volume --size 800x600 --set /render/samples=1)
check "large pictures" 0 "$tessera" replay cell.tsr --animation "${large[@]}" -o large
env $(as again 0 2) "$tessera" replay cell.tsr --animation "${large[@]}" -o again >/dev/null 2>&1 &
first=$!
for _ in $(seq 3000); do
    [ -e again.blocks/result-1 ] && break
    sleep 0.01
done
kill -KILL $first
wait $first 2>/dev/null
if [ -e again.blocks/complete ]; then
    echo "all was drawn before the process could be killed"
else
    touch -d '2001-01-01' again/frame-0000.png
    rm again/frame-0001.png
    check "the next run" 0 "$tessera" replay cell.tsr --animation "${large[@]}" -o again
    [ "$(date -r again/frame-0000.png +%Y)" = 2001 ] || fail "what was drawn is drawn again"
    for i in {0..8}; do cmp large/frame-000$i.png again/frame-000$i.png || fail "frame $i differs after a kill"; done
    [ -e again.blocks ] && fail "again.blocks is left"
fi

if command -v mpirun >/dev/null; then
    mpi=(env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe)
    check "mpirun" 0 "${mpi[@]}" -n 2 "$tessera" stats cell.tsr --all-times --of O2,T -o mpi.csv
    check "the same alone" 0 "$tessera" stats cell.tsr --all-times --of O2,T -o one.csv
    cmp one.csv mpi.csv || fail "mpirun gives other statistics"
else
    echo "mpirun is not installed: its variables were set by hand only"
fi
finish
