"""The page served on this machine, for this machine alone."""

import webbrowser
from collections.abc import Callable
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from restitution._internal.arrays import flag, whole
from restitution._internal.parameters import ParameterError, wrong
from restitution.explorer._page import page


def serve(
    fragment: str = "", *, port: int = 0, browse: bool = True, tell: Callable[[str], object] = print
) -> None:
    """Serve the explorer until Ctrl-C.

    Parameters
    ----------
    fragment : str
        What follows # in its address: a set-up, from `restitution.explorer.link`.
    port : int
        Port on this machine, in [0, 65535]; 0 takes a free one.
    browse : bool
        Open the browser.
    tell : callable
        Called with the address once the page is served.

    Raises
    ------
    ValueError
        If `port` is out of range.
    OSError
        If the port is taken.
    """
    port, browse = whole("port", port, 0, 65535), flag("browse", browse)
    if not isinstance(fragment, str):
        raise ParameterError(wrong("fragment", fragment, "text, as from restitution.explorer.link"))
    if not callable(tell):
        raise ParameterError(wrong("tell", tell, "a function of one text"))
    content = page().encode()

    class Handler(BaseHTTPRequestHandler):
        def handle(self) -> None:
            with suppress(ConnectionError):  # of a browser that closes before it has the page
                super().handle()

        def do_GET(self) -> None:
            if self.path.partition("?")[0] != "/":
                self.send_error(404)
                return
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, format: str, *arguments: object) -> None:
            """Keep the terminal quiet."""

    with ThreadingHTTPServer(("127.0.0.1", port), Handler) as server:
        address = f"http://127.0.0.1:{server.server_port}/"
        if fragment:
            address += f"#{fragment}"
        tell(address)
        if browse:
            webbrowser.open(address)
        server.serve_forever()
