# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""The command line program that the package brings: `limen`, or `python -m limen`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

__all__ = ["PROGRAM", "main"]

PROGRAM = Path(__file__).with_name("limen_program")


def main() -> None:
    """Becomes the program, with the arguments of this process."""
    if not PROGRAM.exists():
        sys.exit(f"limen: error: the program is not there: {PROGRAM} (build the target limen_python_package)")
    os.execv(PROGRAM, ["limen", *sys.argv[1:]])


if __name__ == "__main__":
    main()
