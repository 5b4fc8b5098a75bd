#!/bin/bash
# Processes that pack one series together, as mpirun and srun start them: arguments TESSERA SOURCE_DIR. KILLS: how many
# are killed.
# shellcheck disable=SC2046
tessera=$1
source "$2/tests/e2e/common.bash"
kills=${KILLS:-6}

python3 - <<'EOF2'
import array, json, math
times, nx, ny, nz = 12, 40, 36, 44
with open("run.raw", "wb") as file:
    for t in range(times):
        for p in range(2):
            array.array("f", [300 + 40 * math.sin(x * .2 + t * .3) * math.cos(y * .15 + p) + z * .7
                              for z in range(nz) for y in range(ny) for x in range(nx)]).tofile(file)
json.dump({"dims": [nx, ny, nz], "dtype": "float32", "times": [t * .5 for t in range(times)],
           "components": [{"name": "T", "unit": "K"}, {"name": "p", "unit": "Pa"}]}, open("run.json", "w"))
EOF2
options=(--max-error 0.0001 --block-times 2)

check "one process" 0 "$tessera" pack run.json -o one.tsr "${options[@]}"
say "6 of 6 blocks packed, .*; one.tsr: .*error within 0.0001 of range" out.txt
check "verify" 0 "$tessera" verify one.tsr
check "without blocks" 0 "$tessera" pack run.json -o whole.tsr --max-error 0.0001
check "unpack it" 0 "$tessera" unpack whole.tsr -o whole.raw
check "unpack the blocks" 0 "$tessera" unpack one.tsr -o blocks.raw
python3 - <<'EOF2' || fail "blocks hold other samples than the bound allows"
import array, sys
a, b = (array.array("f", open(name, "rb").read()) for name in ("whole.raw", "blocks.raw"))
sys.exit(len(a) != len(b) or not max(abs(x - y) for x, y in zip(a, b)) <= 2e-4 * 111)
EOF2
check "without a bound" 0 "$tessera" pack run.json -o exact.tsr --lattice cc --block-times 5
check "unpack that" 0 "$tessera" unpack exact.tsr -o exact.raw
cmp run.raw exact.raw || fail "it is not lossless"

ranks 0 first 3 "$tessera" pack run.json -o three.tsr "${options[@]}"
cat rank?.txt
[ "$(awk '/^[0-9]+ of 6 blocks packed by process [1-3] of 3/ { sum += $1 } END { print sum }' rank?.txt)" = 6 ] ||
    fail "the blocks are not shared"
[ "$(grep -c 'three.tsr: ' rank?.txt | grep -c ':1')" = 1 ] || fail "not one process has named the archive"
cmp one.tsr three.tsr || fail "three processes make another archive than one"

if command -v mpirun >/dev/null; then
    mpi=(env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe)
    check "mpirun" 0 "${mpi[@]}" -n 2 "$tessera" pack run.json -o mpi.tsr "${options[@]}"
    cmp one.tsr mpi.tsr || fail "mpirun makes another archive"
    check "mpirun chooses blocks" 0 "${mpi[@]}" -n 3 "$tessera" pack run.json -o mpi.tsr --json
    say '"blocks": 3' out.txt
    check "verify that" 0 "$tessera" verify mpi.tsr
    "${mpi[@]}" -n 2 "$tessera" pack nothing.json -o bad.tsr >out.txt 2>err.txt && fail "a bad file is no failure"
    say "nothing.json: no such file" err.txt
else
    echo "mpirun is not installed: its variables were set by hand only"
fi

# A single time is shared by its parameters.
python3 - <<'EOF2'
import json
about = json.load(open("run.json"))
about["times"] = [0]
json.dump(about, open("single.json", "w"))
open("single.raw", "wb").write(open("run.raw", "rb").read()[:2 * 40 * 36 * 44 * 4])
EOF2
check "by parameter" 0 "$tessera" pack single.json -o parameters.tsr --max-error 0.0001 --block-parameters
say "2 of 2 blocks packed" out.txt
check "a time alone" 0 "$tessera" pack single.json -o single.tsr --max-error 0.0001
ranks 0 single 2 "$tessera" pack single.json -o both.tsr --max-error 0.0001
cmp parameters.tsr both.tsr || fail "two processes make another archive of a single time"
"$tessera" unpack single.tsr -o single-a.raw >/dev/null && "$tessera" unpack both.tsr -o single-b.raw >/dev/null
cmp single-a.raw single-b.raw || fail "parameters packed apart are other samples"
check "one process, by parameter" 0 "$tessera" pack run.json -o parts.tsr "${options[@]}" --block-parameters

# By slabs, all processes pack the same time together.
slabs=(--max-error 0.0001 --brick-size 8)
check "times of small bricks" 0 "$tessera" pack run.json -o slabs.tsr "${slabs[@]}" --block-times 1
ranks 0 slabs 3 "$tessera" pack run.json -o three.tsr "${slabs[@]}" --block-slabs
cat rank?.txt
cmp slabs.tsr three.tsr || fail "slabs make another archive than whole times"
ranks 0 idle 3 "$tessera" pack single.json -o idle.tsr "${slabs[@]}" --progress-json
"$tessera" pack single.json -o parts-of-one.tsr "${slabs[@]}" --block-parameters >/dev/null
cmp parts-of-one.tsr idle.tsr || fail "three processes make another archive of a single time of two parameters"

# Each of them keeps within the memory that was allowed; all of this time at once takes more.
python3 - <<'EOF2'
import json, os
dims = [64, 64, 6000]
with open("long.raw", "wb") as file: file.write(os.urandom(2 * dims[0] * dims[1] * dims[2]))
json.dump({"dims": dims, "dtype": "uint16", "times": [0], "components": [{"name": "x"}]}, open("long.json", "w"))
EOF2
check "too little memory" 2 "$tessera" pack long.json -o long.tsr --lattice cc --block-slabs --memory 12
least=$(sed -n 's/.*needs about \([0-9]*\) MB.*/\1/p' err.txt)
check "a long time at once" 0 "$tessera" pack long.json -o long.tsr --lattice cc --block-times 1 --json
cp out.txt whole.txt
ranks 0 long 2 "$tessera" pack long.json -o long-slabs.tsr --lattice cc --memory "$least" --json
cmp long.tsr long-slabs.tsr || fail "slabs within little memory make another archive"
python3 - "$least" <<'EOF2' || fail "two processes by slabs take more memory than allowed"
import json, sys
both, all_ = [json.load(open(f"rank{i}.txt"))["peakMemory"] / 1e6 for i in (0, 1)], json.load(open("whole.txt"))["peakMemory"] / 1e6
print("MB of each of two processes:", both, "of", sys.argv[1], "allowed; at once:", all_)
sys.exit(not 0 < max(both) <= float(sys.argv[1]) < all_)
EOF2
rm -f long.raw long.tsr long-slabs.tsr
check "slabs of a threshold" 2 "$tessera" pack run.json -o x.tsr "${slabs[@]}" --block-slabs \
    --threshold.kind hard --threshold.value 0.01
say "a threshold depends on all slabs" err.txt

# One of two processes is killed at a random moment; the other ends the work, or a second run does.
for run in $(seq "$kills"); do
    rm -rf killed.tsr killed.tsr.blocks
    how=("${options[@]}") whole=one.tsr
    case $((run % 3)) in
    1) how+=(--block-parameters) whole=parts.tsr ;;
    2) how=("${slabs[@]}" --block-slabs) whole=slabs.tsr ;;
    esac
    env $(as "$run" 0 2) "$tessera" pack run.json -o killed.tsr "${how[@]}" >/dev/null 2>&1 &
    first=$!
    env $(as "$run" 1 2) "$tessera" pack run.json -o killed.tsr "${how[@]}" >/dev/null 2>&1 &
    second=$!
    sleep "0.$(printf %02d $((RANDOM % 60)))"
    [ $((run / 2 % 2)) = 0 ] && pid=$first || pid=$second
    kill -KILL $pid 2>/dev/null
    [ $((run % 4)) = 0 ] && kill -KILL $first $second 2>/dev/null
    [ -e killed.tsr.blocks ] || kill -KILL $first $second 2>/dev/null # nobody is left who makes the folder
    wait
    [ ! -e killed.tsr ] || cmp $whole killed.tsr || fail "a kill left another archive"
    [ ! -e killed.tsr.blocks/joined.tsr ] || "$tessera" verify killed.tsr.blocks/joined.tsr >/dev/null ||
        fail "a kill left damaged blocks"
    check "a second run" 0 "$tessera" pack run.json -o killed.tsr "${how[@]}"
    cmp $whole killed.tsr || fail "another archive after a kill"
done

# Nothing is left beside the archive where one process was killed and the others ended the work, nor where all were
# killed and the first process of the next job is not the first to come.
await() { # await FILE
    for _ in $(seq 300); do
        [ -e "$1" ] && return
        sleep 0.01
    done
    return 1
}
start() { # start JOB RANK COUNT
    env $(as "$@") "$tessera" pack run.json -o left.tsr "${options[@]}" >/dev/null 2>&1 &
    pids[$2]=$!
}
for try in $(seq 20); do # until the kill is not too late
    rm -f left.tsr
    pids=()
    for rank in 0 1 2; do start survivors$try $rank 3; done
    await left.tsr.blocks/came-survivors$try--2
    kill -KILL "${pids[2]}" 2>/dev/null
    wait "${pids[2]}"
    killed=$?
    wait
    [ $killed = 137 ] && break
done
[ $killed = 137 ] || fail "every kill came too late"
cmp one.tsr left.tsr || fail "the others make another archive"
[ -e left.tsr.blocks ] && fail "the others leave $(ls left.tsr.blocks)"
for try in $(seq 20); do
    rm -rf left.tsr left.tsr.blocks
    pids=()
    for rank in 0 1; do start killed$try $rank 2; done
    await left.tsr.blocks/came-killed$try--1
    kill -KILL "${pids[@]}" 2>/dev/null
    wait
    [ -e left.tsr.blocks/job.json ] && break
done
[ -e left.tsr.blocks/job.json ] || fail "every kill came too late"
start next 1 2
await left.tsr.blocks/came-next--1 || fail "the next job does not go on"
start next 0 2
wait
cmp one.tsr left.tsr || fail "the next job makes another archive"
[ -e left.tsr.blocks ] && fail "the next job leaves $(ls left.tsr.blocks)"

mkdir other.tsr.blocks
echo '{}' >other.tsr.blocks/job.json
check "a folder of other work" 2 "$tessera" pack run.json -o other.tsr "${options[@]}"
say "other.tsr.blocks: belongs to other data or options" err.txt
check "D4*" 2 "$tessera" pack run.json -o x.tsr --lattice d4 --block-times 2
say "depend on all times" err.txt
check "a size" 2 "$tessera" pack run.json -o x.tsr --target-size 1 --block-times 2
check "a negative number" 1 "$tessera" pack run.json -o x.tsr --block-times -1
check "append in blocks" 2 "$tessera" pack run.json --append -o one.tsr --block-times 2
say "of a whole series" err.txt
check "alone beside others" 0 env $(as job 1 2) "$tessera" pack run.json -o alone.tsr --max-error 0.0001 --alone
cmp whole.tsr alone.tsr || fail "packing alone beside others gives another archive"
# Files that have changed, or are read otherwise, are other work.
env $(as changed 0 2) "$tessera" pack run.json -o changed.tsr "${options[@]}" >/dev/null
rm changed.tsr.blocks/complete
touch run.raw # beside run.json
check "changed files" 2 "$tessera" pack run.json -o changed.tsr "${options[@]}"
rm -r changed.tsr.blocks
ls x.* 2>/dev/null && fail "something was left behind"
finish
