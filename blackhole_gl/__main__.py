"""`python -m blackhole_gl`, which `blackhole-gl` is, too."""

import gc


def main() -> None:
    """Runs the command line."""
    gc.disable()  # what imports make is there to stay: looking through it again and again takes a tenth of the start
    from . import cli

    gc.freeze()
    gc.enable()
    cli.main()


if __name__ == "__main__":
    main()
