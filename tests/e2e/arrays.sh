#!/bin/bash
# The Python package reads and writes archives as arrays: see arrays.py and uneven_arrays.py. Skipped (77) where it was not built.
# Arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"
package=$(dirname "$tessera")/python
ls "$package"/tessera/_tessera*.so > /dev/null 2>&1 || { echo "skipped: no Python module"; exit 77; }
/usr/bin/python3 -c "import numpy" 2> /dev/null || { echo "skipped: no NumPy"; exit 77; }
for tests in arrays uneven_arrays; do
    PYTHONPATH=$package PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$2/tests/e2e/$tests.py" "$tessera" || fail "$tests.py"
done
finish
