"""`cuscus city fetch` against an Overpass server of this test's own, in a network of its own: what it
asks, what it accepts, and that nothing is left of an answer that is not whole.
"""

import ctypes
import http.server
import pathlib
import shutil
import ssl
import subprocess
import tempfile
import threading
import time
import unittest
import urllib.parse

from cuscus_run import BIN

CLONE_NEWNET = 0x40000000
BBOX = "11.34,44.49,11.35,44.5"
MAP = (b'<?xml version="1.0" encoding="UTF-8"?>\n<osm version="0.6" generator="test">\n'
       b'  <node id="1" lat="44.495" lon="11.345"/>\n</osm>\n')


class Interpreter(http.server.BaseHTTPRequestHandler):
    """Does what the server's `answer` does."""

    protocol_version = "HTTP/1.1"

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.server.asked.append((self.path, dict(self.headers), body))
        self.close_connection = True
        self.server.answer(self)

    def reply(self, body, status=200, length=None, **headers):
        self.send_response(status)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()
        try:
            self.wfile.write(body)
        except OSError:
            pass  # the client has had enough

    def log_message(self, *_):
        pass


def setUpModule():
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.unshare(CLONE_NEWNET) != 0:
        raise unittest.SkipTest("SKIPPED: needs root for a network of its own")
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)


class CityFetch(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-fetch-"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.out = self.folder / "x.osm"
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Interpreter)
        self.server.asked = []
        self.server.answer = lambda request: request.reply(MAP)
        self.addCleanup(self.server.server_close)
        threading.Thread(target=self.server.serve_forever, args=(0.05,), daemon=True).start()
        self.addCleanup(self.server.shutdown)
        self.url = f"http://127.0.0.1:{self.server.server_port}/api/interpreter"

    def fetch(self, *options, url=None, bbox=BBOX, env=None):
        return subprocess.run([BIN / "cuscus", "city", "fetch", "--bbox", bbox, "--server",
                               url or self.url, "--out", self.out, *map(str, options)],
                              capture_output=True, text=True, timeout=60, env=env,
                              stdin=subprocess.DEVNULL)

    def refused(self, *options, says, code=1, **more):
        done = self.fetch(*options, **more)
        self.assertEqual(done.returncode, code, done)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def answer(self, *arguments, **headers):
        self.server.answer = lambda request: request.reply(*arguments, **headers)

    def test_map_is_what_the_server_sent(self):
        done = self.fetch()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.out.read_bytes(), MAP)
        self.assertIn("OpenStreetMap contributors", done.stdout)
        self.assertEqual(list(self.folder.iterdir()), [self.out])

    def test_query_asks_for_what_a_city_is_made_of_within_the_box(self):
        self.fetch("--timeout", "90s", "--max-mb", 20)
        (path, headers, body), = self.server.asked
        self.assertEqual(path, "/api/interpreter")
        self.assertTrue(headers["User-Agent"].startswith("cuscus/"))
        query, = urllib.parse.parse_qs(body.decode())["data"]
        # South, west, north, east: Overpass' order.
        self.assertIn("[bbox:44.4900000,11.3400000,44.5000000,11.3500000]", query)
        self.assertIn("[timeout:90][maxsize:20000000]", query)
        for wanted in ('way["building"]', 'relation["building"]', 'way["building:part"]',
                       'way["highway"]', 'node["natural"="tree"]', "(._;>;);"):
            self.assertIn(wanted, query)

    def test_answer_in_chunks(self):
        def in_chunks(request):
            request.send_response(200)
            request.send_header("Transfer-Encoding", "chunked")
            request.end_headers()
            for at in range(0, len(MAP), 7):
                piece = MAP[at:at + 7]
                request.wfile.write(b"%x\r\n%s\r\n" % (len(piece), piece))
            request.wfile.write(b"0\r\n\r\n")
        self.server.answer = in_chunks
        self.assertEqual(self.fetch().returncode, 0)
        self.assertEqual(self.out.read_bytes(), MAP)

    def test_errors_of_http_and_of_overpass_are_named(self):
        page = (b'<html><body><p>The data ...</p><p><strong style="color:#FF0000">Error</strong>: line 1: '
                b'parse error: Unknown type "nod" </p></body></html>')
        self.answer(page, 400)
        self.refused(says=("HTTP 400", 'line 1: parse error: Unknown type "nod"'))
        self.answer(b"slow down", 429)
        self.refused(says=("HTTP 429", "wait a little", "slow down"))
        self.answer(b"", 504)
        self.refused(says=("HTTP 504", "busy"))
        self.answer(MAP.replace(b"</osm>", b'<remark> runtime error: Query timed out in "query" '
                                           b'at line 3 after 181 seconds. </remark></osm>'))
        self.refused(says=("gave up", 'Query timed out in "query" at line 3'))

    def test_redirection_is_not_followed(self):
        self.answer(b"", 302, Location="http://elsewhere.example/api")
        self.refused(says=("redirects to 'http://elsewhere.example/api'", "--server"))
        self.assertEqual(len(self.server.asked), 1)

    def test_answer_that_is_no_map(self):
        self.answer(b"<html><body>Welcome to our hotel</body></html>")
        self.refused(says=("no OpenStreetMap data", "Welcome to our hotel"))

    def test_answer_that_breaks_off(self):
        self.answer(MAP[:-20], length=len(MAP))
        self.refused(says=("receive the answer",))
        self.answer(MAP[:-20])
        self.refused(says=("ends before the data do",))

    def test_answer_that_is_too_large(self):
        padded = MAP.replace(b"</osm>", b" " * 1_000_000 + b"</osm>")
        self.answer(padded)
        self.refused("--max-mb", 1, says=("larger than 1 MB", "--max-mb"))

        def without_length(request):
            request.send_response(200)
            request.end_headers()
            try:
                request.wfile.write(padded)
            except OSError:
                pass  # the client has had enough
        self.server.answer = without_length
        self.refused("--max-mb", 1, says=("larger than 1 MB",))
        self.assertEqual(self.fetch("--max-mb", 2).returncode, 0)

    def test_server_that_is_not_there(self):
        closed = self.url.replace(str(self.server.server_port), "1")
        self.refused(url=closed, says=("127.0.0.1:1", "connect", "refused"))

    def test_interrupt_leaves_nothing(self):
        started = threading.Event()
        go_on = threading.Event()
        self.addCleanup(go_on.set)

        def halfway(request):
            request.send_response(200)
            request.send_header("Content-Length", str(len(MAP)))
            request.end_headers()
            request.wfile.write(MAP[:50])
            started.set()
            go_on.wait(30)
        self.server.answer = halfway
        process = subprocess.Popen([BIN / "cuscus", "city", "fetch", "--bbox", BBOX, "--server", self.url,
                                    "--out", self.out], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        self.assertTrue(started.wait(20))
        deadline = time.monotonic() + 5
        while time.monotonic() < deadline and f"{self.folder}" not in self.open_files(process.pid):
            time.sleep(0.01)
        process.kill()
        process.wait(10)
        self.assertEqual(list(self.folder.iterdir()), [])

    @staticmethod
    def open_files(pid):
        return " ".join(str(link.readlink()) for link in pathlib.Path(f"/proc/{pid}/fd").iterdir())

    def test_bad_input_asks_nobody(self):
        self.refused(bbox="1,2,3", code=2, says=("--bbox 1,2,3", "WEST,SOUTH,EAST,NORTH"))
        self.refused(bbox="10,40,11,41", code=2, says=("1.00 square degrees", "0.25"))
        self.refused(url="ftp://x/y", code=2, says=("--server 'ftp://x/y'", "http://"))
        self.refused(url="http://x:99999/", code=2, says=("99999",))
        self.refused(url="http://a b/", code=2, says=("a b",))
        self.refused("--timeout", "0s", code=2, says=("--timeout 0s", "1 s ... 1 h"))
        self.refused("--max-mb", "0", code=2, says=("--max-mb 0",))
        self.assertEqual(self.server.asked, [])

    def test_https_with_a_certificate_that_is_trusted(self):
        secrets = pathlib.Path(tempfile.mkdtemp(prefix="cuscus-fetch-tls-"))
        self.addCleanup(shutil.rmtree, secrets, True)
        key, certificate = secrets / "key.pem", secrets / "cert.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                        "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2", "-subj", "/CN=localhost",
                        "-addext", "subjectAltName=DNS:localhost", "-keyout", key, "-out", certificate],
                       check=True, capture_output=True)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key)
        self.server.socket = context.wrap_socket(self.server.socket, server_side=True)
        url = f"https://localhost:{self.server.server_port}/api/interpreter"
        self.refused(url=url, says=("TLS", "certificate verify failed"))
        trusting = {"SSL_CERT_FILE": str(certificate)}
        self.refused(url=url.replace("localhost", "127.0.0.1"), env=trusting,
                     says=("TLS", "certificate verify failed"))
        done = self.fetch(url=url, env=trusting)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.out.read_bytes(), MAP)


if __name__ == "__main__":
    unittest.main()
