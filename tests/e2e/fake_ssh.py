"""Stands for ssh in tests/e2e/remote.sh: serves the sftp subsystem (version 3, reading only) on stdin and stdout, or ends
as ssh does when FAKE_SSH_SAYS holds what it would say. Its command line is appended to FAKE_SSH_LOG."""
import os, struct, sys

with open(os.environ["FAKE_SSH_LOG"], "a") as log:
    print(*sys.argv[1:], file=log)
if os.environ.get("FAKE_SSH_SAYS"):
    print(os.environ["FAKE_SSH_SAYS"], file=sys.stderr)
    sys.exit(255)


def text(bytes_, at):
    (length,) = struct.unpack_from(">I", bytes_, at)
    return bytes_[at + 4:at + 4 + length], at + 4 + length


def answer(kind, body):
    sys.stdout.buffer.write(struct.pack(">IB", len(body) + 1, kind) + body)
    sys.stdout.buffer.flush()


files = {}
most = int(os.environ.get("FAKE_SSH_MOST", 1 << 15))  # bytes of an answer; fewer than asked for are allowed
while len(head := sys.stdin.buffer.read(4)) == 4:
    message = sys.stdin.buffer.read(*struct.unpack(">I", head))
    kind, number = message[0], message[1:5]
    if kind == 1:
        answer(2, struct.pack(">I", 3))
    elif kind == 3:
        path, at = text(message, 5)
        try:
            files[b"h%d" % len(files)] = open(path, "rb")
            handle = b"h%d" % (len(files) - 1)
            answer(102, number + struct.pack(">I", len(handle)) + handle)
        except FileNotFoundError:
            answer(101, number + struct.pack(">I", 2) + struct.pack(">I", 0) * 2)
    elif kind == 4:
        handle, _ = text(message, 5)
        files[handle].close()  # its name stays taken
        answer(101, number + struct.pack(">I", 0) * 3)
    elif kind == 8:
        handle, _ = text(message, 5)
        about = os.fstat(files[handle].fileno())
        answer(105, number + struct.pack(">IQIIIII", 15, about.st_size, 0, 0, about.st_mode, 0, int(about.st_mtime)))
    elif kind == 5:
        handle, at = text(message, 5)
        offset, length = struct.unpack_from(">QI", message, at)
        files[handle].seek(offset)
        data = files[handle].read(min(length, most))
        answer(103, number + struct.pack(">I", len(data)) + data)
