"""`python -m blackhole_gl` is `blackhole-gl`."""

from .cli import main

if __name__ == "__main__":
    main()
