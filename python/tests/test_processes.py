# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
import multiprocessing
import unittest

import limen


def register(case, answers):
    answers.put(limen.register(*case).outcome)


class ForkedProcesses(unittest.TestCase):
    """On Linux multiprocessing forks: the child has its parent's memory, but none of its threads."""

    def test_a_child_registers_after_its_parent(self):
        limen.set_threads(4)
        self.addCleanup(limen.set_threads, 0)
        case = limen.simulate("room", points_indoor=30_000, stations=2).scans
        here = limen.register(*case).outcome
        context = multiprocessing.get_context("fork")
        answers = context.Queue()
        child = context.Process(target=register, args=(case, answers))
        child.start()
        try:
            self.assertEqual(answers.get(timeout=300), here)
            child.join(60)
            self.assertEqual(child.exitcode, 0)
        finally:
            child.kill()


if __name__ == "__main__":
    unittest.main()
