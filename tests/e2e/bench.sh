#!/bin/bash
# `tessera bench` starts the program tessera-bench beside it, with its words and its exit status.
tessera=$1
source "$2/tests/e2e/common.bash"

check "help" 0 "$tessera" bench --help
say "Usage: tessera bench" out.txt
say "lattice" out.txt
check "an unknown table" 1 "$tessera" bench nonsense
say "nonsense" err.txt
check "an option without effect" 2 "$tessera" bench lattice --volume ball
say "--volume" err.txt

# Without it: said plainly.
mkdir alone
cp "$tessera" alone/tessera
check "no tessera-bench" 2 alone/tessera bench lattice
say "tessera-bench" err.txt
check "the rest works" 0 alone/tessera --version
finish
