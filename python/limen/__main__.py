# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""The command line program that the package brings: `limen`, or `python -m limen`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

__all__ = ["main"]


def main() -> None:
    """Becomes the program, with the arguments of this process."""
    program = Path(__file__).with_name("limen_program")
    if not program.exists():
        sys.exit(f"limen: error: the program is not there: {program} (build the target limen_python_package)")
    os.execv(program, ["limen", *sys.argv[1:]])


if __name__ == "__main__":
    main()
