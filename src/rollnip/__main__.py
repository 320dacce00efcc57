"""The command as `python -m rollnip`, for where it is not on the path."""

from rollnip.cli import main

if __name__ == "__main__":
    main()
