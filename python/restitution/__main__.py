"""`python -m restitution`: the command line."""

from restitution._cli import main

if __name__ == "__main__":
    main()
