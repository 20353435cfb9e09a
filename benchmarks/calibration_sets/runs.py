# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of the program whose answers are kept: the same program, files and arguments are not run twice."""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time


@functools.lru_cache(maxsize=None)
def sha256(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


class Runner:
    def __init__(self, program, work, jobs, kept_only=False):
        self.program = str(pathlib.Path(program).resolve())
        self.runs = work / "runs"
        self.runs.mkdir(parents=True, exist_ok=True)
        self.jobs = jobs
        self.kept_only = kept_only

    def key(self, arguments, files):
        asked = [sha256(self.program), arguments, [[sha256(str(f)), pathlib.Path(f).name] for f in files]]
        return hashlib.sha256(json.dumps(asked).encode()).hexdigest()[:24]

    def answer(self, command, files, options, answer_name, threads):
        """The answer's JSON, with the exit status, CPU and wall seconds of the run that made it; None where it may not
        be run and was not."""
        kept = self.runs / f"{self.key([command, *options], files)}.json"
        if kept.is_file():
            return json.loads(kept.read_text())
        if self.kept_only:
            return None
        with tempfile.TemporaryDirectory(dir=self.runs, prefix="run-") as folder:
            out = pathlib.Path(folder)
            run = self.run([self.program, command, *map(str, files), *options, "--threads", str(threads), "--quiet",
                            "-o", str(out / "out")], out)
            answer = out / "out" / answer_name
            run["answer"] = json.loads(answer.read_text()) if answer.is_file() else {}
            part = out / "kept.json"
            part.write_text(json.dumps(run))
            if run["answer"] and run["exit"] >= 0:  # an outcome; what failed is tried again
                shutil.move(part, kept)
        return run

    @staticmethod
    def run(command, folder):
        start = time.monotonic()
        with open(folder / "said", "w+", encoding="utf-8", errors="replace") as said:
            child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said)
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            words = said.read().strip()
        return {"exit": child.returncode, "cpu_s": round(used.ru_utime + used.ru_stime, 2),
                "wall_s": round(time.monotonic() - start, 2), "said": words}

    def pair(self, pair):
        return self.answer("register", [pair.source.path, pair.target.path], ["--no-report"], "result.json", 1)

    def project(self, one):
        return self.answer("project", [scan.path for scan in one.scans], [], "project.json", self.jobs)

    def pairs(self, pairs, on_done):
        """The answers, in the order of the pairs; one thread of the program for each job."""
        def one(pair):
            run = self.pair(pair)
            if run:
                on_done(pair, run)
            return run
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(one, pairs))
