"""For windows that nobody looks at."""

BLIND = {"LP_NO_RAST": "1"}
"""Environment in which Mesa's software renderer fills no pixels, half of what a window's frame takes; other drivers fill them."""
