# SPDX-License-Identifier: BSD-3-Clause
"""Makes the tasks of a study on the workers of a Dask scheduler, and appends their logs to one.

usage: study_on_dask.py ADDRESS LOG, with a task on each line of standard input: the words of a command, as JSON.

A task whose worker died is made again on another worker. A task that fails is reported, and the others continue.
"""
import json
import os
import sys

WAIT_S = 10  # assumed: a running scheduler answers much sooner


def make(words):
    """Runs the command on a worker. Returns the log that the command writes."""
    import os
    import subprocess
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        log = os.path.join(folder, "log.jsonl")
        try:
            ended = subprocess.run(words + ["--log", log], stdin=subprocess.DEVNULL, capture_output=True, text=True)
        except FileNotFoundError:
            raise RuntimeError(f"a worker has no program '{words[0]}' on its PATH") from None
        if ended.returncode != 0:
            raise RuntimeError(ended.stderr.strip()[-400:])
        with open(log, encoding="utf-8") as file:
            return file.read()


def tell(done, tasks, is_last):
    if sys.stderr.isatty():
        print(f"\r{done} of {tasks} tasks", end="\n" if is_last else "", file=sys.stderr, flush=True)


def main(address, log):
    try:
        from distributed import CancelledError, Client, as_completed
    except ImportError:
        sys.exit("vps: --dask needs Dask for python3 (Debian: python3-distributed)")
    tasks = [json.loads(line) for line in sys.stdin]
    try:
        client = Client(address, timeout=WAIT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        print(f"vps: no Dask scheduler answers at {address} ({error or 'no answer'}); start one with dask-scheduler",
              file=sys.stderr, flush=True)
        os._exit(1)  # a client that never connected waits for itself when it is destroyed
    if not client.scheduler_info()["workers"]:
        print("vps: warning: the scheduler has no workers yet; start some with dask-worker", file=sys.stderr)
    with open(log, encoding="utf-8") as file:
        head = file.readline()
    # Two commands with the same words are two tasks.
    futures = [client.submit(make, words, pure=False) for words in tasks]
    failed, done = [], 0
    for future in as_completed(futures, loop=client.loop):
        try:
            text = future.result()
            if not text.startswith(head):
                raise RuntimeError("a worker's scene or its vps differs from those of this machine")
        except CancelledError:
            failed.append("the scheduler is gone")
            continue
        except Exception as error:
            failed.append(str(error) or type(error).__name__)
            continue
        with open(log, "a", encoding="utf-8") as file:
            file.write(text[len(head):])
        done += 1
        tell(done, len(tasks), done == len(tasks))
    if failed:
        sys.exit(f"vps: {len(failed)} of {len(tasks)} tasks failed, the first with: {failed[0]}")


try:
    main(sys.argv[1], sys.argv[2])
except KeyboardInterrupt:
    sys.exit("vps: stopped")
