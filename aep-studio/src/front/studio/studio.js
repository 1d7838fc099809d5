// The page: what the studio says, drawn; what happens, heard.

const page = { state: null, effects: [], compared: null, choosing: false, asked: 0 };

async function refresh() {
  const mine = ++page.asked;
  const state = await ask("/api/state");
  if (mine !== page.asked) return;
  const other = page.state && (page.state.data !== state.data || page.state.models.length !== state.models.length);
  page.state = state;
  if (other) {
    page.compared = null;
    page.choosing = false;
    page.effects = await ask("/api/effects");
  }
  if (!state.models.some((model) => model.id === page.compared) || page.compared === state.chosen) page.compared = null;
  render();
}

function render() {
  const { state } = page;
  part("folder").textContent = state.folder;
  part("file").textContent = [state.data, heldSaid(state.hold)].filter(Boolean).join(" · ");
  const loading = Boolean(state.brought) || !state.data || page.choosing;
  drawLoad(state, page.choosing);
  drawActions(state, loading);
  drawStatus(state);
  part("loop").hidden = loading || !state.models.length;
  drawModels(state, page.compared);
  drawCandidates(state, page.effects);
  drawParameters(state);
  drawLaw(state);
  drawNext(state);
  drawControl(state);
  drawRiddle(state, page.effects);
  drawFiles(state);
  for (const name of ["parameters", "law", "next", "control", "riddle", "files", "data"]) {
    const host = part(name);
    host.hidden = loading || !host.childElementCount;
  }
  if (loading) return;
  Promise.all([drawPictures(state, page.compared), drawData(state)]).catch((refusal) => {
    pictures.key = null;
    notice(refusal);
  });
}

function compareWith(id) {
  page.compared = id;
  render();
}

// How the force is read where nobody said it.
const heldSaid = (hold) =>
  hold && `the force is taken as ${hold.hold === "sampled" ? "sampled" : "a command that is held between samples"}: that predicts better${hold.doubtful ? ", but hardly; if you know it, say so under Other data" : ""}`;

function drawActions(state, loading) {
  const chosen = state.models.find((model) => model.id === state.chosen);
  draw("actions", [state.chosen, chosen?.parent, loading, state.data, state.brought], () => {
    const made = [];
    if (!loading && chosen) {
      made.push(button("Undo", undo, { disabled: chosen.parent == null, title: "back to the model before (u); this one stays in the tree" }));
      made.push(button("What is missing?", () => send("/api/task", { task: "suggest", from: state.chosen })));
      made.push(button("Find all of it", () => send("/api/task", { task: "discover", from: state.chosen }), { class: "main", title: "search every effect that the chosen model lacks" }));
    }
    if (state.data) made.push(button(loading ? "Back" : "Other data", () => { page.choosing = !page.choosing; render(); }, { hidden: Boolean(state.brought) }));
    return made;
  });
}

async function undo() {
  const chosen = page.state.models.find((model) => model.id === page.state.chosen);
  if (chosen?.parent != null) await send("/api/choose", { model: chosen.parent });
}

// What is being done, what was left by a killed server, what failed.
function drawStatus(state) {
  const { job, interrupted, failed } = state;
  draw("status", [job && [job.said, job.message, job.times_said], interrupted, failed], () => {
    if (job) {
      const times = job.times == null ? "" : `: ${job.effects.join(" + ")}: ${job.times_said} times what the sensors make`;
      const message = job.message && job.message !== job.said && job.times == null ? `: ${job.message}` : "";
      return [element("span", { class: "spinner", "aria-hidden": "true" }), element("span", { class: "doing" }, `${job.said}${message}${times}`), button("Cancel", () => send("/api/cancel"))];
    }
    if (interrupted) return [element("span", {}, `The studio ended while it was ${interrupted.said}. Everything else is as it was.`), button("Do it again", () => send("/api/task", interrupted.task), { class: "main" }), button("Leave it", () => send("/api/discard"))];
    if (failed) return [element("span", { class: "warn" }, [failed.what, failed.hint].filter(Boolean).join(". "))];
    return [];
  });
}

addEventListener("keydown", (event) => {
  if (event.target.matches("input, select, textarea, .chart") || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === "u") attempt(undo);
});

// Where the studio went away the page says so, and goes on when it is there again.
const lost = () => {
  part("status").hidden = false;
  part("status").replaceChildren(element("span", { class: "warn" }, "The studio does not answer. Start it again in the same folder: nothing but a fit in progress is lost."));
  shown.delete("status");
};
attempt(async () => {
  page.effects = await ask("/api/effects");
  await refresh();
  document.documentElement.dataset.ready = "yes";
});
listen((message) => {
  if (message.progress && page.state) {
    page.state.job = message.progress;
    drawStatus(page.state);
    drawModels(page.state, page.compared);
  }
  // What was refused stays to be read.
  if (message.changed) refresh().catch(notice);
}, lost);
