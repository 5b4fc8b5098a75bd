#!/bin/bash
# Archives on servers that state far more than there is: arguments TESSERA SOURCE_DIR. What is only stated costs no
# memory: the program may have 1.5 GB here, of which it needs a tenth to start.
tessera=$1
source "$2/tests/e2e/common.bash"
served() { # served WHAT HEADER TEXT: opening the file is refused with the text
    python3 "$here/lying_server.py" "$2" >port &
    local server=$!
    for _ in $(seq 100); do
        [ -s port ] && break
        sleep 0.1
    done
    # shellcheck disable=SC2016
    check "$1" 2 timeout 60 bash -c 'ulimit -v 1500000; exec "$@"' _ "$tessera" info "http://127.0.0.1:$(cat port)/run.tsr"
    say "$3" err.txt
    kill "$server"
    rm port
}
here=$2/tests/e2e
# Headers of a file of 5e18 bytes, with right checksums (codec/FORMAT.md, section 1): metadata of 400 bytes and a page of
# the rest; metadata of 4e9 bytes.
served "a huge index" 895453520d0a1a0a030000000f0000000000f44482916345a000000000000000900100000000000001000000000000003002000000000000d0fdf344829163450200000000000000e3222712775694dc "the metadata is damaged"
served "huge metadata" 895453520d0a1a0a030000000f0000000000f44482916345a00000000000000000286bee000000000100000000000000a0286bee0000000060d7885681916345020000000000000099e761dd331c7cf6 "the metadata are too long"
finish
