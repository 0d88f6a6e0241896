"""The compiled part, of which callers use nothing."""

from typing import Any

def __getattr__(name: str) -> Any: ...
