"""The explorer: the same engine in a web page, served locally or inside a notebook."""

from restitution.explorer._page import link, page
from restitution.explorer._server import serve
from restitution.explorer._widget import explore

__all__ = ["explore", "link", "page", "serve"]
