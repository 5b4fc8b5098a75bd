"""A web server for tests/e2e/remote.sh that answers ranges of the files of a folder: remote_server.py FOLDER PORT_FILE
[CERTIFICATE KEY], with these by https as well; the port file then has both ports.
It misbehaves as /set?NAME=VALUE tells it; /told says what it has sent, as "bytes requests", and forgets it."""
import email.utils, http.server, os, ssl, sys, threading, time, urllib.parse

folder, port_file = sys.argv[1:3]
lock = threading.Lock()
told = {"bytes": 0, "requests": 0, "most": 0, "now": 0, "logins": 0}
# delay: seconds before each answer; busy: answers that are 503; cut: answers that end after half of their bytes;
# endless: 1: errors have a page without an end, 2: answers that lead elsewhere have, 3: heads have none, 4: a head that
# comes a byte a second; logins: requests that came with a password since /told
# rate: bytes a second of all answers together, 0 = any; ranges: 0 = whole files only; damage: answers whose first byte is wrong; password: "user:word", base 64
ways = {"delay": 0.0, "rate": 0.0, "busy": 0, "cut": 0, "ranges": 1, "damage": 0, "password": "", "endless": 0, "elsewhere": "/big.tsr"}


def once(name):
    with lock:
        if ways[name] <= 0:
            return False
        ways[name] -= 1
        return True


free_at = [0.0]  # when the line has sent all before


def wait_for_line(count):
    with lock:
        if ways["rate"] <= 0:
            return
        free_at[0] = max(free_at[0], time.monotonic()) + count / ways["rate"]
        until = free_at[0]
    time.sleep(max(0.0, until - time.monotonic()))


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def say(self, status, body=b"", **headers):
        self.send_response(status)
        for name, value in headers.items():
            self.send_header(name.replace("_", "-"), value)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        where = urllib.parse.urlsplit(self.path)
        if where.path == "/set":
            ways.update({name: type(ways[name])(value) for name, value in urllib.parse.parse_qsl(where.query, True)})
            return self.say(200)
        if where.path == "/told":
            with lock:
                text = "%d %d %d %d\n" % (told["bytes"], told["requests"], told["most"], told["logins"])
                told.update({"bytes": 0, "requests": 0, "most": 0, "logins": 0})
            return self.say(200, text.encode())
        with lock:
            told["requests"] += 1
            told["logins"] += "Authorization" in self.headers
            told["now"] += 1
            told["most"] = max(told["most"], told["now"])
        try:
            time.sleep(ways["delay"])
            self.give(folder + urllib.parse.unquote(where.path))
        finally:
            with lock:
                told["now"] -= 1

    def never_end(self, first, piece, pause):
        self.close_connection = True
        try:
            self.wfile.write(first)
            while True:
                self.wfile.write(piece)
                self.wfile.flush()
                with lock:
                    told["bytes"] += len(piece)
                time.sleep(pause)
        except OSError:
            pass

    def give(self, path):
        page, much = b"HTTP/1.1 %s\r\nContent-Type: text/html\r\n%s\r\n", b"x" * 65536
        if ways["endless"] == 1:
            return self.never_end(page % (b"404 Not Found", b""), much, 0)
        if ways["endless"] == 2 and path.endswith("/elsewhere.tsr"):
            return self.never_end(page % (b"302 Found", b"Location: /big.tsr\r\n"), much, 0)
        if ways["endless"] == 3:
            return self.never_end(b"HTTP/1.1 206 Partial Content\r\n", b"X-A: " + b"x" * 1000 + b"\r\n", 0)
        if ways["endless"] == 4:
            return self.never_end(b"HTTP/1.1 206 Partial Content\r\n", b"X", 1)
        if once("busy"):
            return self.say(503)
        if path.endswith("/elsewhere.tsr"):
            return self.say(302, Location=ways["elsewhere"])
        if ways["password"] and self.headers.get("Authorization") != "Basic " + ways["password"]:
            return self.say(401, WWW_Authenticate='Basic realm="x"')
        try:
            with open(path, "rb") as file:
                size, changed = os.fstat(file.fileno()).st_size, os.fstat(file.fileno()).st_mtime_ns
                first, last = 0, size - 1
                wanted = self.headers.get("Range") if ways["ranges"] else None
                if wanted:
                    first, last = (int(number) for number in wanted.removeprefix("bytes=").split("-"))
                    if first >= size:
                        return self.say(416, Content_Range="bytes */%d" % size)
                    last = min(last, size - 1)
                file.seek(first)
                body = file.read(last + 1 - first)
        except FileNotFoundError:
            return self.say(404, b"nothing here")
        if once("damage"):
            body = bytes([body[0] ^ 255]) + body[1:]
        self.send_response(206 if wanted else 200)
        if wanted:
            self.send_header("Content-Range", "bytes %d-%d/%d" % (first, last, size))
        self.send_header("ETag", '"%x-%x"' % (size, changed))
        self.send_header("Last-Modified", email.utils.formatdate(changed // 10**9, usegmt=True))
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if once("cut"):
            body = body[:len(body) // 2]
            self.close_connection = True
        with lock:
            told["bytes"] += len(body)
        try:
            for at in range(0, len(body), 65536):
                wait_for_line(len(body[at:at + 65536]))
                self.wfile.write(body[at:at + 65536])
        except OSError:
            self.close_connection = True


servers = [http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)]
if len(sys.argv) > 3:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(*sys.argv[3:])
    servers.append(http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler))
    servers[1].socket = context.wrap_socket(servers[1].socket, server_side=True)
    threading.Thread(target=servers[1].serve_forever, daemon=True).start()
with open(port_file + ".new", "w") as file:
    file.write(" ".join(str(server.server_port) for server in servers))
os.rename(port_file + ".new", port_file)
servers[0].serve_forever()
