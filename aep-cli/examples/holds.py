"""How often the hold of a force is told rightly where nobody states it.

    python aep-cli/examples/holds.py PATH/TO/aep FOLDER [COUNT]

Each recording is the force of a challenge that hides nothing (seeds 101 ..), under which `aep simulate` moves the same model,
held from sample to sample in every other one and sampled in the rest, as an encoder of 1 um shows it. `aep discover` is told
nothing of the hold. Needs numpy.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np

AEP, FOLDER = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2])
COUNT = int(sys.argv[3]) if len(sys.argv) > 3 else 20


def aep(*words):
    subprocess.run([AEP, *map(str, words)], check=True, capture_output=True)


right = silent = 0
for k in range(1, COUNT + 1):
    hold = "zero-order" if k % 2 else "sampled"
    desk = FOLDER / str(k)
    aep("challenge", "--hide", "nothing", "--seed", 100 + k, "-o", desk, "-q")
    (desk / "recording.toml").unlink()
    (desk / "model.json").write_text(json.dumps(json.loads((desk / "truth.json").read_text())["model"]))
    aep("simulate", "--model", desk / "model.json", "--input", desk / "recording.csv", "--hold", hold, "-o", desk / "motion.csv", "-q")
    motion = np.genfromtxt(desk / "motion.csv", delimiter=",", names=True)
    position = np.round(motion["position_m"] / 1e-6) * 1e-6
    rows = np.column_stack([motion["time_s"], motion["force_N"], position])
    np.savetxt(desk / "run.csv", rows, delimiter=",", header="time_s,force_N,position_m", comments="", fmt="%.9g")
    aep("discover", desk / "run.csv", "--json", desk / "found.json", "-q")
    text = (desk / "found.json").read_text()
    told = "taken as held" if hold == "zero-order" else "taken as sampled"
    right += told in text
    silent += json.loads(text)["verdict"] == "nothing_missing"
    print(f"{k}: {hold}, {'told' if told in text else 'NOT TOLD'}, {json.loads(text)['verdict']}", flush=True)
print(f"hold told rightly in {right} of {COUNT}; nothing named in {silent}")
