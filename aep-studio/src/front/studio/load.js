// A recording: chosen, looked at, mapped, taken.

async function bringFile(file) {
  if (!file) return;
  await sendFile(`/api/upload?name=${encodeURIComponent(file.name)}`, file);
}

function dropZone() {
  const input = element("input", { type: "file", id: "file", class: "unseen", onchange: () => attempt(() => bringFile(input.files[0])) });
  const zone = element(
    "div",
    { class: "drop" },
    element("p", {}, element("label", { for: "file", class: "as-button" }, "Choose a recording"), input, " or drop one here."),
    element("p", { class: "lead" }, "CSV with the columns time_s, force_N, position_m (or others: they are mapped in the next step), MATLAB, Parquet, .npz, .xlsx, HDF5, MCAP. It stays on this machine."),
  );
  zone.addEventListener("dragover", (event) => {
    event.preventDefault();
    zone.classList.add("over");
  });
  zone.addEventListener("dragleave", () => zone.classList.remove("over"));
  zone.addEventListener("drop", (event) => {
    event.preventDefault();
    zone.classList.remove("over");
    attempt(() => bringFile(event.dataTransfer.files[0]));
  });
  return zone;
}

function drawLoad(state, wanted) {
  draw("load", [state.brought, state.data, wanted], () => {
    if (state.brought) {
      mapping();
      return [heading("How is it read?"), element("p", { class: "lead" }, "Looking into the file.")];
    }
    if (state.data && !wanted) return [];
    return [
      heading("What does your model lack?"),
      element("p", { class: "lead" }, "Choose a measurement of a drive. A model is fitted to it, its error is shown where it lies, and effects are added one by one until nothing is left."),
      dropZone(),
      element("p", {}, button("Try it on the example", () => send("/api/example"), { class: "main" }), " ", button("Solve a riddle", () => send("/api/riddle", {}))),
    ];
  });
}

// Back to the models, or to the choice of a file.
const leaveFile = () => button("Not this file", () => send("/api/leave"), { title: "forget it; models stay as they are" });

const ABOUT = {
  time: "one instant for each row",
  force: "or torque, voltage, current: what the drive gives; a formula over columns may stand here",
  position: "or angle",
  velocity: "where it was measured",
  reference: "the position that was asked for",
  segment: "a number for each piece of the recording",
  temperature: "",
  enabled: "0 where the drive is switched off",
  model_force: "what your own model gives for the same rows: what that one lacks is looked for",
};

// Roles with their columns, units and gains, a check as soon as something changes.
async function mapping() {
  let seen;
  try {
    seen = await ask("/api/preview");
  } catch (refusal) {
    notice(refusal);
    part("load").replaceChildren(heading("This file cannot be read"), element("p", {}, `${refusal.message}. ${refusal.hint ?? ""}`), dropZone(), button("Use the example", () => send("/api/example")), " ", leaveFile());
    return;
  }
  const given = seen.mapping;
  const rows = seen.roles.map((role) => {
    const now = given[role.name] ?? {};
    const guess = seen.guesses[role.name] ?? "";
    const column = element("input", { list: "columns", value: now.column ?? "", placeholder: guess || (role.required ? "choose a column" : "none"), "aria-label": `column of ${role.name}`, name: role.name, autocomplete: "off" });
    const unit = element("select", { "aria-label": `unit of ${role.name}` }, option("", "as named"), ...role.units.map((one) => option(one, one, one === now.unit)), ...(role.name.includes("force") ? ["V", "A"].map((one) => option(one, one, one === now.unit)) : []));
    const gain = element("input", { type: "number", step: "any", value: now.gain ?? "", placeholder: "1", "aria-label": `gain of ${role.name}` });
    const read = () => {
      const source = { column: column.value.trim() || null, unit: unit.value || null, gain: gain.value === "" ? null : Number(gain.value) };
      return Object.values(source).every((value) => value == null) ? null : source;
    };
    return { role, read, row: element("tr", {}, element("th", { scope: "row" }, role.name.replace("_", " "), element("small", {}, ABOUT[role.name])), element("td", {}, column), element("td", {}, unit), element("td", {}, gain)) };
  });
  const hold = element("select", { "aria-label": "force between samples" }, option("", "decided by what predicts better"), option("zero-order", "a command, held", given.hold === "zero-order"), option("sampled", "sampled", given.hold === "sampled"));
  const interval = element("input", { type: "number", step: "any", value: given.interval_s ?? "", placeholder: "where the file has no time", "aria-label": "sampling interval in seconds" });
  const effects = element("input", { placeholder: "coulomb, viscous, offset", "aria-label": "effects of the base model", autocomplete: "off" });
  const read = () => ({
    ...Object.fromEntries(rows.map(({ role, read: source }) => [role.name, source()])),
    hold: hold.value || null,
    interval_s: interval.value === "" ? null : Number(interval.value),
    regressors: given.regressors,
    topic: given.topic,
  });
  const names = () => effects.value.split(/[,+]/).map((name) => name.trim()).filter(Boolean);
  const said = element("div", { class: "checked", "aria-live": "polite" });
  const go = button("Fit the base model", () => send("/api/take", { mapping: read(), effects: names().length ? names() : null }), { class: "main", disabled: true });
  let asked = 0;
  const check = async () => {
    const mine = ++asked;
    try {
      const { html } = await send("/api/check", { mapping: read() });
      if (mine !== asked) return;
      fill(said, html);
      go.disabled = false;
    } catch (refusal) {
      if (mine !== asked) return;
      go.disabled = true;
      said.replaceChildren(element("div", { class: "doubt" }, element("b", {}, refusal.message), refusal.place ? ` (${refusal.place})` : "", refusal.hint ? element("p", {}, refusal.hint) : ""));
    }
  };
  const required = rows.filter(({ role }) => role.required).map(({ row }) => row);
  const others = rows.filter(({ role }) => !role.required).map(({ row }) => row);
  const head = () => element("thead", {}, element("tr", {}, ...["Quantity", "Column or formula", "Unit", "Gain"].map((name) => element("th", { scope: "col" }, name))));
  const table = (body) => element("div", { class: "scroll" }, element("table", { class: "mapping" }, head(), element("tbody", {}, ...body)));
  const first = seen.columns.map((column) =>
    element("tr", {}, element("th", { scope: "row" }, column.name), element("td", {}, column.unit ?? ""), ...column.first.map((value) => element("td", { class: "num" }, value == null ? "–" : number(value, 5))), element("td", { class: "num" }, String(column.len))),
  );
  const more = seen.more ? `, and ${seen.more} more columns` : "";
  const fields = element("div", { oninput: settled(check) });
  fields.append(
    heading(`How is ${seen.file} read?`),
    element("p", { class: "lead" }, seen.layout ? `Recognised as ${seen.layout}. ` : "", "What is left empty is told by the columns' names (shown in grey). The check below follows every change."),
    element("datalist", { id: "columns" }, ...seen.columns.map((column) => option(column.name))),
    table(required),
    element("details", {}, element("summary", {}, "Further quantities, the force between samples, the base model"), table(others), element("div", { class: "fields" }, field("Force between samples", hold), field("Sampling interval, s", interval), field("Base model", effects))),
    element("p", {}, go, " ", leaveFile()),
    element("details", {}, element("summary", {}, `The first rows of ${seen.columns.length} columns${more}`), element("div", { class: "scroll" }, element("table", {}, element("tbody", {}, ...first)))),
    said,
  );
  part("load").replaceChildren(fields);
  check();
}
