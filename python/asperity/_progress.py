"""The bar of ``progress=True``."""

from __future__ import annotations

import sys
import time
from importlib import import_module
from typing import Any

from asperity._asperity import State


class Bar:
    """A bar by tqdm if that is installed, and a line on stderr otherwise."""

    def __init__(self) -> None:
        self._bar: Any = None
        self._last = 0.0
        self._shown = False
        try:
            tqdm = import_module("tqdm.auto")
        except ImportError:
            return
        style = "{l_bar}{bar}| {elapsed}{postfix}"
        self._bar = tqdm.tqdm(total=100.0, bar_format=style, leave=False)

    def __call__(self, done: float, state: State) -> None:
        words = f"{state.contact_nodes} nodes, W = {state.load:.3e} N"
        if self._bar is not None:
            self._bar.n = 100.0 * done
            self._bar.set_postfix_str(words)
        elif time.monotonic() - self._last >= 1.0:
            self._last = time.monotonic()
            self._shown = True
            print(f"\r{100.0 * done:3.0f} %  {words}   ", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Takes the bar away."""
        if self._bar is not None:
            self._bar.close()
        elif self._shown:
            print(file=sys.stderr)
