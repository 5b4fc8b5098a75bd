#!/bin/bash
# Numbers without a window: regions, sections, balances, as text, CSV, SVG and JSON.
tessera=$1
source "$2/tests/e2e/common.bash"

"$tessera" generate fuel-cell --even -o cell.raw --size 11x13x21 --times 2 > /dev/null 2>err || die "make a cell"
"$tessera" stats cell.raw --time 0 > out.txt 2>err || die "statistics of regions"
say 'Parameter' out.txt
say 'numbers as computed' out.txt
for command in "stats cell.raw" "stats cell.raw --balance O2" "stats cell.raw --along z --of T" "mesh cell.raw --channel T --iso 353.4 -o x.ply"; do
    # shellcheck disable=SC2086
    for time in 99 -7; do
        check "$command at time $time" 2 "$tessera" $command --time $time
        say "is not in 0 .. " err.txt
    done
done
check "the last time, as info shows it" 0 "$tessera" stats cell.raw --time "$("$tessera" info cell.raw | sed -n 's/^  times .* to \([0-9.]*\).*/\1/p')"
"$tessera" stats cell.raw --all-times -o regions.csv > /dev/null 2>err || die "regions over time"
[ "$(cut -d, -f1 regions.csv | sort -u | wc -l)" -eq 4 ] || die "origin, head and two times: $(head -3 regions.csv)"
"$tessera" stats cell.raw --along z --of O2,T --weight massflow -o along.csv > /dev/null 2>err || die "sections"
[ "$(grep -c ',O2,' along.csv)" -ge 21 ] || die "a line for each plane"
"$tessera" stats cell.raw --along z --of O2 -o along.svg > /dev/null 2>err || die "sections as a figure"
say '<svg' along.svg
say 'mean of O2' along.svg
"$tessera" stats cell.raw --along z --of O2 -o along.pdf > /dev/null 2>err || die "sections as a PDF"
[ "$(head -c 5 along.pdf)" = %PDF- ] || fail "no PDF"
"$tessera" stats cell.raw --line 0,0,0,0.001,0.002,0.04 --planes 5 --of T --json > line.json 2>err || die "a line"
say '"kind": "statistics"' line.json
"$tessera" stats cell.raw --balance O2 > out.txt 2>err || die "a balance"
say 'mol/s' out.txt
say 'reacts' out.txt
"$tessera" stats cell.raw --balance O2 -o balance.svg > /dev/null 2>err || die "a balance as a figure"
python3 - <<'PY' || fail "the balance has no bars"
import re
bars = [float(w) for w in re.findall(r'<rect [^>]* width="([0-9.]+)" height="[0-9.]+" fill="#(?!ffffff)[0-9a-f]+"', open("balance.svg").read())]
assert len([w for w in bars if 15 < w < 200]) >= 6, bars
PY
"$tessera" stats cell.raw --all-times --balance O2 -o balances.svg > /dev/null 2>err || die "balances over time"
say 'total: reacts' balances.svg
"$tessera" stats cell.raw --all-times --of O2 -o means.svg > /dev/null 2>err || die "means over time"
say 'mean of O2' means.svg
say 'cathode channel' means.svg

# Names of regions, stated once, are known the next time, and go into archives.
"$tessera" pack cell.raw -o named.tsr --lattice cc --lossless --label 'region:0=plate#112233' > /dev/null 2>err || die "pack with names"
"$tessera" info named.tsr > out.txt
say '0 plate, 1 ' out.txt
say ' \.\. [-0-9.e]*, 2 parts by region' out.txt
grep -q ',$' out.txt && fail "a list ends with a comma: $(grep ',$' out.txt)"
"$tessera" stats cell.raw --by region --of T > out.txt 2>err || die "remembered names"
say 'plate' out.txt
"$tessera" stats named.tsr --by region --of T --label region:0=rib > out.txt 2>err || die "names over those of an archive"
say 'rib' out.txt

# Archives with a bound keep numbers of their source.
near() { # near A B: the same tables but for rounding: of nine digits, and of differences
    python3 - "$1" "$2" <<'PY'
import sys
def number(text):
    try:
        return float(text)
    except ValueError:
        return None
a, b = (open(name).read().splitlines() for name in sys.argv[1:])
assert len(a) == len(b), (len(a), len(b))
for line, other in zip(a, b):
    fields, others = line.split(","), other.split(",")
    assert len(fields) == len(others), (line, other)
    most = max([abs(number(x)) for x in fields if number(x) is not None], default=0)
    for x, y in zip(fields, others):
        if x != y:
            assert abs(number(x) - number(y)) <= max(2e-9 * abs(number(x)), 1e-11 * most), (line, other)
PY
}
"$tessera" generate fuel-cell --even -o series.raw --size 11x13x21 --times 8 > /dev/null 2>err || die "make a series"
for lattice in cc bcc d4; do
    "$tessera" pack series.raw -o "$lattice.tsr" --lattice $lattice --max-error 0.01 > /dev/null 2>err || die "pack on $lattice"
    "$tessera" info "$lattice.tsr" > out.txt && say '  regions    their numbers as computed from the source, ' out.txt
    for question in "--all-times" "--balance O2 --all-times" "--by none"; do
        # shellcheck disable=SC2086
        "$tessera" stats series.raw $question -o want.csv > /dev/null 2>err || die "stats $question"
        # shellcheck disable=SC2086
        "$tessera" stats "$lattice.tsr" $question -o got.csv > /dev/null 2>err || die "stats $question on $lattice"
        near want.csv got.csv || fail "$question on $lattice: $(diff want.csv got.csv | head -4)"
    done
    "$tessera" plot series.raw --y 'mean(T)' --region 1 -o want.csv 2>err || die "plot"
    "$tessera" plot "$lattice.tsr" --y 'mean(T)' --region 1 -o got.csv 2>err || die "plot on $lattice"
    near want.csv got.csv || fail "curves on $lattice: $(diff want.csv got.csv | head -4)"
    "$tessera" stats "$lattice.tsr" --along z --of O2 -o got.csv > /dev/null 2>err || die "sections on $lattice"
    say 'error of mean' got.csv
    say 'error at most' got.csv
done

# Wrong words: status 2 and one line.
for words in "--of nothing" "--by T" "--along w" "--line 1,2,3" "--balance nothing" "--regions nowhere" \
    "--along z --balance O2" "--velocity T --balance O2" "--label region:x=a" "--label nothing:1=a" "-o out.txt" \
    "--along z --planes 5" "--show flux" "--all-times --time 0"; do
    # shellcheck disable=SC2086
    check "$words" 2 "$tessera" stats cell.raw $words
    [ "$(wc -l < err.txt)" -eq 1 ] || fail "not one line: $words: $(cat err.txt)"
done
check "a weight that is none" 1 "$tessera" stats cell.raw --along z --weight heavy
finish
