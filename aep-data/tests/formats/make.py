"""One recording in every format: run with numpy, pyarrow, openpyxl. The numbers are the same to the bit;
spreadsheets hold 15 digits or so, which is why they are rounded here."""

import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq

time = np.round(np.arange(120) * 0.01, 2)
columns = {
    "time_s": time,
    "force_N": np.round(3.0 * np.sin(5.0 * time) + 0.1, 9),
    "position_m": np.round(0.01 * np.cos(5.0 * time) / 3.0, 9),
}
with open("run.csv", "w") as out:
    out.write(",".join(columns) + "\n")
    for row in zip(*columns.values()):
        out.write(",".join(repr(float(value)) for value in row) + "\n")
np.savez("run.npz", **columns)
np.savez_compressed("packed.npz", **columns)
pq.write_table(pa.table(columns), "run.parquet")
lists = {
    "timestamp": time,
    "observation.state": [[a, b] for a, b in zip(columns["position_m"], columns["force_N"])],
    "task": ["pick"] * len(time),
}
pq.write_table(pa.table(lists), "lerobot.parquet")
book = openpyxl.Workbook()
sheet = book.active
sheet.append(["Recorder: X"])
sheet.append(["time", "force", "position"])
sheet.append(["s", "N", "m"])
for row in zip(*columns.values()):
    sheet.append([float(value) for value in row])
book.save("run.xlsx")
