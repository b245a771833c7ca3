"""`python -m blackhole_gl`, which `blackhole-gl` is, too."""

import gc


def main() -> None:
    """Runs the command line.

    What imports make is there to stay: looking through it again and again for what may go takes a tenth of the start, and once more at the end a tenth of
    what a small picture takes.
    """
    gc.disable()
    from . import cli

    gc.freeze()
    gc.set_threshold(10_000)  # commands import more
    gc.enable()
    try:
        cli.main()
    finally:
        gc.freeze()


if __name__ == "__main__":
    main()
