# Sourced by the scripts beside it: a folder of their own to work in, and checks that go on after a failure. The last
# line of each is `finish`.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
finish() { # an exit status of its own: so many failures might be taken for a skipped test
    exit $((failures > 0))
}
export XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
cd "$work" || exit 1
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
die() { # die TEXT: for what the rest of a script stands on
    echo "FAILED: $*"
    [ -f err ] && cat err
    exit 1
}
check() { # check WHAT STATUS COMMAND...: runs the command, output in out.txt and err.txt, and compares its exit status
    local what=$1 want=$2
    shift 2
    "$@" >out.txt 2>err.txt
    local got=$?
    [ "$got" = "$want" ] || {
        fail "$what: exit status $got, not $want"
        cat out.txt err.txt
    }
}
say() { # say TEXT FILE: the file must hold the text
    grep -q -- "$1" "$2" || {
        fail "no \"$1\" in:"
        cat "$2"
    }
}
ranks() { # ranks STATUS JOB COUNT COMMAND...: by so many processes, each of which must end so; what they say is in rank*.txt
    local status=$1 job=$2 count=$3 rank children=()
    shift 3
    rm -f rank*.txt
    for rank in $(seq 0 $((count - 1))); do
        env $(as "$job" "$rank" "$count") "$@" >"rank$rank.txt" 2>&1 &
        children+=($!)
    done
    for rank in "${children[@]}"; do
        wait "$rank"
        [ $? = "$status" ] || fail "$*: a process does not end with $status: $(cat rank*.txt)"
    done
}
as() { # as JOB RANK COUNT: what Open MPI says to a process in its environment
    echo "OMPI_COMM_WORLD_RANK=$2 OMPI_COMM_WORLD_SIZE=$3 OMPI_COMM_WORLD_LOCAL_SIZE=$3 PMIX_NAMESPACE=$1"
}
