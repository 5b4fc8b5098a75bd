"""A web server that answers each request for a range with as many bytes as were asked for, of a file that it states to
have 5e18 bytes: the header in the first argument, then zeros. Prints its port."""
import http.server
import sys

SIZE = 5 * 10**18
head = bytes.fromhex(sys.argv[1]) * 2


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_GET(self):
        first, last = (int(number) for number in self.headers["Range"].removeprefix("bytes=").split("-"))
        last = min(last, SIZE - 1)
        self.send_response(206)
        self.send_header("Content-Range", "bytes %d-%d/%d" % (first, last, SIZE))
        self.send_header("Content-Length", str(last + 1 - first))
        self.send_header("ETag", '"a"')
        self.end_headers()
        body = (head + bytes(max(0, min(last + 1 - first, 1 << 24)))) if first < len(head) else bytes(min(last + 1 - first, 1 << 24))
        self.wfile.write(body[first : last + 1] if first < len(head) else body)


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
print(server.server_port, flush=True)
server.serve_forever()
