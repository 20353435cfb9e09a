#!/usr/bin/env python3
# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Gives the jobs of `limen project --engine dask` to Dask.

Jobs come on stdin, one JSON object a line: {"id": 3, "name": "pair a and b", "words": ["DIR", "pair", ...]}.
Answers go to stdout: {"id": 3, "state": "done" | "bad_input" | "failed", "words": "why"}; {"ready": true} once
the scheduler is there; {"note": ...} where something went wrong and is made good; {"fault", "where", "remedy"} where
nothing can go on. The end of stdin ends the program. A job is one call of `limen project work`, which does what
the project's store does not hold yet: it may run any number of times, anywhere.

Workers may have another limen: LIMEN_PROGRAM in their environment names it.
"""
import argparse
import json
import logging
import os
import queue
import sys
import threading
import time

DEBIAN_PYTHON = "/usr/bin/python3"
PACKAGES = "python3-distributed python3-cryptography"
CRASHES = 3  # of limen itself, before a job is given up
PATIENCE_S = 90.0  # with a folder that is not there or a disk that is full
SCHEDULER_PATIENCE_S = 300.0  # with a scheduler that is gone
CONNECT_S = 10.0
TICK_S = 0.2


def say(**line):
    sys.stdout.write(json.dumps(line) + "\n")
    sys.stdout.flush()


def end(status):
    """At once: no thread of Dask's holds it up."""
    sys.stdout.flush()
    os._exit(status)


def fault(words, where, remedy):
    say(fault=words, where=where, remedy=remedy)
    end(2)


def perform(program, words):
    """One job, on a worker: the child ends with the worker (it asks for that itself)."""
    import json
    import os
    import signal
    import socket
    import subprocess

    program = os.environ.get("LIMEN_PROGRAM", program)
    command = [program, "project", "work", *words, "--threads", "1", "--quiet", "--json"]
    environment = dict(os.environ, LIMEN_WORKER_PID=str(os.getpid()))
    answer = {"state": "crashed", "words": "", "host": socket.gethostname()}
    try:
        done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, check=False)
    except OSError as error:
        return dict(answer, state="unavailable", words=f"{program} cannot be started there: {error.strerror}")
    if done.returncode == 0:
        return dict(answer, **json.loads(done.stdout))
    if done.returncode < 0:
        return dict(answer, words=f"limen was ended by {signal.Signals(-done.returncode).name}")
    lines = done.stderr.decode(errors="replace").strip().splitlines()
    return dict(answer, words=lines[-1] if lines else f"limen ended with status {done.returncode}")


class Job:
    """A job with what became of it so far."""

    def __init__(self, line):
        self.number = line["id"]
        self.name = line["name"]
        self.words = line["words"]
        self.starts = 0
        self.crashes = 0
        self.first_missed = None  # when its folder or its disk failed it first
        self.not_before = 0.0


class Cluster:
    """The connection to Dask: to a scheduler that was named, or to workers of our own on the loopback.

    Whoever reaches a scheduler or a worker without TLS runs programs as its user: ours ask for a certificate that
    is made for this run and never leaves its processes.
    """

    def __init__(self, options):
        self.options = options
        self.own = None
        self.client = None

    def connect(self):
        from distributed import Client

        if self.options.scheduler or self.options.scheduler_file:
            self.client = Client(self.address(), security=self.security(), timeout=CONNECT_S, set_as_default=False)
            return
        if self.own is None:
            self.own = self.started()
        self.client = Client(self.own, security=self.own.security, timeout=CONNECT_S, set_as_default=False)

    def started(self):
        import dask
        from distributed import Nanny, Scheduler, SpecCluster
        from distributed.security import Security

        # A server for pages cannot be left out: it listens on the loopback alone, and has none.
        dask.config.set({"distributed.scheduler.http.routes": [], "distributed.worker.http.routes": []})
        security = Security.temporary()
        both = {
            "host": "127.0.0.1",
            "protocol": "tls://",
            "security": security,
            "dashboard": False,
            "dashboard_address": "127.0.0.1:0",
        }
        worker = {"cls": Nanny, "options": dict(both, nthreads=1, memory_limit=None, silence_logs=logging.WARN)}
        return SpecCluster(
            scheduler={"cls": Scheduler, "options": dict(both, port=0)},
            workers={number: worker for number in range(self.options.workers)},
            worker=worker,
            security=security,
            silence_logs=logging.WARN,
        )

    def address(self):
        """The scheduler's; refused where others could be it, or run programs in our name."""
        address = self.options.scheduler
        if not address:
            with open(self.options.scheduler_file, encoding="utf-8") as file:
                address = json.load(file)["address"]
        if not address.startswith("tls://") and not self.options.trust_network:
            fault(
                f"the scheduler {address} is not protected by TLS: anybody who can reach it, from this machine "
                "too, can run programs as you",
                "--scheduler",
                "start it with --protocol tls and give its tls:// address, or --trust-network if only you can reach it",
            )
        return address

    def security(self):
        """Certificates that were named, else those of Dask's own configuration."""
        from distributed.security import Security

        options = self.options
        named = {
            "tls_ca_file": options.tls_ca,
            "tls_client_cert": options.tls_cert,
            "tls_client_key": options.tls_key,
        }
        security = Security(**{key: value for key, value in named.items() if value})
        if self.address().startswith("tls://") and not security.tls_ca_file:
            fault(
                "the authority that signed the scheduler's certificate is unknown",
                "--tls-ca",
                "give --tls-ca, --tls-cert and --tls-key, or set distributed.comm.tls in Dask's configuration",
            )
        return security

    def alive(self):
        return self.client is not None and self.client.status == "running"

    def room(self):
        """Jobs that can run at once."""
        workers = self.client.scheduler_info().get("workers", {})
        return sum(worker.get("nthreads", 1) for worker in workers.values())

    def drop(self):
        client, self.client = self.client, None
        if client is not None:
            threading.Thread(target=lambda: client.close(timeout=2), daemon=True).start()

    def close(self):
        try:
            if self.client is not None:
                self.client.close(timeout=2)
            if self.own is not None:
                self.own.close(timeout=5)
        except Exception:  # whatever it is: we are leaving
            pass


class Driver:
    """Keeps as many jobs in the air as there are workers: so a worker's end is held against one job alone."""

    def __init__(self, options):
        self.cluster = Cluster(options)
        self.program = options.program
        self.waiting = []  # jobs, the next one last
        self.flying = {}  # future's key: (job, future)
        self.events = queue.Queue()
        self.told_no_workers = False

    def hear(self):
        """The other end of stdin, in a thread of its own."""
        for text in sys.stdin:
            self.events.put(("job", Job(json.loads(text))))
        self.events.put(("end", None))

    def run(self):
        self.reconnect(first=True)
        say(ready=True)
        threading.Thread(target=self.hear, daemon=True).start()
        while True:
            if not self.cluster.alive():
                self.lose_all()
                self.reconnect(first=False)
            self.submit()
            try:
                self.take(*self.events.get(timeout=TICK_S))
                while True:
                    self.take(*self.events.get_nowait())
            except queue.Empty:
                pass
            self.look_after()

    def take(self, kind, what):
        if kind == "end":
            threading.Timer(8.0, end, [0]).start()
            self.cluster.close()
            end(0)
        elif kind == "job":
            self.waiting.insert(0, what)
        else:
            self.settle(what)

    def reconnect(self, first):
        start = time.monotonic()
        reported = first
        while True:
            try:
                self.cluster.connect()
                if not first:
                    say(note="the scheduler is back")
                return
            except (OSError, ValueError, KeyError, TypeError) as error:  # the file may be written at this moment
                self.cluster.drop()
                where = self.cluster.options.scheduler or self.cluster.options.scheduler_file or "this machine"
                if time.monotonic() - start > (CONNECT_S if first else SCHEDULER_PATIENCE_S):
                    fault(f"Dask's scheduler cannot be reached: {error}", where, "start it, and run again")
                if not reported:
                    say(note=f"the scheduler {where} is gone; waiting for it")
                    reported = True
            self.pause()

    def pause(self):
        """Waits a little, and still hears the end of stdin."""
        held = []
        deadline = time.monotonic() + 1.0
        while time.monotonic() < deadline:
            try:
                event = self.events.get(timeout=TICK_S)
            except queue.Empty:
                continue
            if event[0] == "end":
                self.take(*event)
            if event[0] == "job":
                held.append(event)
        for event in held:
            self.take(*event)

    def lose_all(self):
        self.cluster.drop()
        for job, _ in self.flying.values():
            self.waiting.append(job)
        self.flying.clear()

    def submit(self):
        room = self.cluster.room() - len(self.flying)
        if self.waiting and room <= 0 and not self.flying and not self.told_no_workers:
            self.told_no_workers = True
            say(note="there is no worker yet; waiting for one")
        now = time.monotonic()
        ready = [job for job in reversed(self.waiting) if job.not_before <= now]
        for job in ready[: max(0, room)]:
            self.waiting.remove(job)
            job.starts += 1
            key = f"limen-{job.number}-{job.starts}-{job.name}"
            # Not `retries`: what fails for good reason is in the answer, and a worker's end is retried anyway.
            future = self.cluster.client.submit(perform, self.program, job.words, key=key, pure=False)
            self.flying[key] = (job, future)
            future.add_done_callback(lambda done: self.events.put(("settled", done.key)))

    def look_after(self):
        """Futures whose scheduler forgot them come to no end by themselves."""
        for key, (job, future) in list(self.flying.items()):
            if future.status in ("lost", "cancelled"):
                del self.flying[key]
                self.waiting.append(job)

    def settle(self, key):
        if key not in self.flying:
            return
        job, future = self.flying.pop(key)
        if future.status == "finished":
            self.judge(job, future.result())
        elif future.status == "error":
            self.judge_error(job, future.exception())
        else:
            self.waiting.append(job)

    def judge_error(self, job, error):
        from distributed.scheduler import KilledWorker

        if isinstance(error, KilledWorker):
            say(note=f"{job.name}: ended its worker repeatedly; given up")
            say(id=job.number, state="failed", words="it ended its worker repeatedly")
        else:
            self.judge(job, {"state": "crashed", "words": f"{type(error).__name__}: {error}", "host": "?"})

    def judge(self, job, answer):
        state = answer["state"]
        words = answer["words"]
        if state == "crashed":
            job.crashes += 1
            if job.crashes < CRASHES:
                job.not_before = time.monotonic() + job.crashes
                self.waiting.append(job)
                return
            say(note=f"{job.name}: failed {CRASHES} times, at last on {answer['host']}: {words}; given up")
            say(id=job.number, state="failed", words=words)
        elif state == "unavailable":
            self.put_off(job, words, answer["host"])
        else:
            say(id=job.number, state=state, words=words)

    def put_off(self, job, words, host):
        now = time.monotonic()
        if job.first_missed is None:
            job.first_missed = now
            say(note=f"{job.name} has to wait: on {host}, {words}")
        if now - job.first_missed > PATIENCE_S:
            fault(
                f"{job.name} cannot be done on {host}: {words}",
                " ".join(job.words[:1]),
                "check the shared folder, its free space and the workers' limen, and run again: finished work is kept",
            )
        job.not_before = now + min(10.0, 0.5 * 2.0 ** min(job.starts, 5))
        self.waiting.append(job)


def parsed():
    parser = argparse.ArgumentParser(description="Gives the jobs of limen project to Dask.")
    for name in ("--program", "--scheduler", "--scheduler-file", "--tls-ca", "--tls-cert", "--tls-key"):
        parser.add_argument(name, default="")
    parser.add_argument("--trust-network", action="store_true")
    parser.add_argument("--workers", type=int, default=1)
    return parser.parse_args()


def main():
    options = parsed()
    try:
        import cryptography  # noqa: F401
        import distributed  # noqa: F401
    except ImportError:
        # The python3 of the PATH may be another than the one that Debian's packages are for.
        if os.path.exists(DEBIAN_PYTHON) and sys.prefix != "/usr":
            os.execv(DEBIAN_PYTHON, [DEBIAN_PYTHON, *sys.argv])
        fault(
            f"--engine dask needs {PACKAGES}, which are not all installed",
            sys.executable,
            f"install them (apt-get install {PACKAGES}), or leave --engine out",
        )
    Driver(options).run()


if __name__ == "__main__":
    main()
