"""The program itself: `python -m trackbed run scene.toml`, or `trackbed run scene.toml`."""

import sys

from ._trackbed import command


def main() -> None:
    """Carries out the command line and ends with the exit code of the program."""
    sys.exit(command(sys.argv[1:]))


if __name__ == "__main__":
    main()
