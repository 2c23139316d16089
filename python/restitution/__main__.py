"""`restitution` and `python -m restitution`: the command line as a process of its own."""

import signal


def main() -> None:
    """Run the command line; Ctrl-C in the first and the last moments of the process shows no traceback."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # There is nothing to be lost then, and Python's own handler would tell where the import was.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from restitution.cli import main as command

    command()


if __name__ == "__main__":
    main()
