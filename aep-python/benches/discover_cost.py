"""What `aep.discover` costs beside the command on the same file, in one run.

    python aep-python/benches/discover_cost.py target/release/aep [FILE [RUNS]]

Seconds of processor time, which other programs on the machine do not change: those of this process's search, and those of the
command as a whole, by turns.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import aep

EXAMPLE = Path(__file__).parents[2] / "aep-cli/examples/hidden/recording.csv"


def used(who) -> float:
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    command, file, runs = (sys.argv[1:] + [str(EXAMPLE), "7"][len(sys.argv) - 2 :])[:3]
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        result = os.path.join(folder, "result.json")
        for _ in range(int(runs)):
            begin = used(resource.RUSAGE_SELF)
            aep.discover(file, time_limit=None).to_json(result)
            ours.append(used(resource.RUSAGE_SELF) - begin)
            begin = used(resource.RUSAGE_CHILDREN)
            subprocess.run([command, "discover", file, "--time-limit", "none", "--quiet", "--json", result], check=True)
            theirs.append(used(resource.RUSAGE_CHILDREN) - begin)
    here, there = statistics.median(ours), statistics.median(theirs)
    print(f"aep.discover {here:.2f} s, the command {there:.2f} s of processor time (medians of {runs}): {here / there:.3f} times")


if __name__ == "__main__":
    main()
