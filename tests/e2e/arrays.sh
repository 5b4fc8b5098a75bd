#!/bin/bash
# The Python package reads and writes archives as arrays: see arrays.py. Skipped (77) where it was not built.
# Arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"
package=$(dirname "$tessera")/python
ls "$package"/tessera/_tessera*.so > /dev/null 2>&1 || { echo "skipped: no Python module"; exit 77; }
/usr/bin/python3 -c "import numpy" 2> /dev/null || { echo "skipped: no NumPy"; exit 77; }
PYTHONPATH=$package PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$2/tests/e2e/arrays.py" "$tessera" || fail "arrays.py"
finish
