// What to run next, riddles, files, the data.

function drawNext(state) {
  const likely = (state.suggestions?.rows ?? []).slice(0, 2).map((candidate) => candidate.effect);
  draw("next", [state.chosen, likely, state.motion && [state.motion.effects, state.motion.motion]], () => {
    if (state.chosen == null) return [];
    const effects = element("input", { value: likely.join(", "), placeholder: "two effects or more", "aria-label": "effects to tell apart", class: "wide", autocomplete: "off" });
    const names = () => effects.value.split(/[,+]/).map((one) => one.trim()).filter(Boolean);
    const made = [
      heading("What to run next"),
      element("p", { class: "lead" }, "Where two effects would do: the motion, within the stroke, speed and acceleration recorded, in which models with the one or the other differ most."),
      element("p", { class: "fields" }, field("Effects to tell apart", effects), button("Look for a motion", () => send("/api/task", { task: "experiment", from: state.chosen, effects: names() }))),
    ];
    const motion = state.motion;
    if (!motion) return made;
    const host = element("div");
    const time = motion.position.map((_, k) => k * motion.step);
    requestAnimationFrame(() => {
      chart(host, { title: `${motion.motion}: tells ${motion.effects.join(" from ")} apart`, x: { label: "time", unit: "s" }, y: { label: "position", unit: motion.unit }, data: [time, motion.position], series: [{ label: "position to follow", colour: "c1" }], height: 200 });
      forgetGone();
    });
    return [...made, element("p", {}, motion.said), host, element("p", {}, fileLink(motion.file))];
  });
}

const fileLink = (path) => element("a", { href: `/api/file?path=${encodeURIComponent(path)}`, download: path.split("/").at(-1) }, path);

const FORMS = [["report", "Report"], ["series", "Series (CSV)"], ["c", "Compensator in C"], ["fmu", "FMU"], ["modelica", "Modelica"], ["mjcf", "MuJoCo"], ["urdf", "URDF"]];

function drawFiles(state) {
  draw("files", [state.chosen, state.files], () => {
    if (state.chosen == null) return [];
    const write = ([form, label]) => button(label, () => send("/api/task", { task: "export", from: state.chosen, form }));
    const rows = state.files.map(({ path, bytes }) => element("li", {}, fileLink(path), ` ${bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`}`));
    return [
      heading("Take it away"),
      element("p", { class: "writes" }, element("span", {}, "The chosen model: "), fileLink(`models/${state.chosen}.json`), ...FORMS.map(write)),
      element("ul", { class: "files" }, ...rows),
    ];
  });
}

function drawRiddle(state, effects) {
  draw("riddle", [state.riddle, state.points, state.data != null, effects.length], () => {
    if (!state.data) return [];
    const size = element("select", { "aria-label": "how well it is hidden" }, ...["clear", "moderate", "faint"].map((one) => option(one)));
    const another = element("p", { class: "fields" }, field("How large the effect is", size), button(state.riddle ? "Another riddle" : "Give me a riddle", () => send("/api/riddle", { size: size.value })), element("span", {}, `Points so far: ${state.points}`));
    const { riddle } = state;
    const lead = element("p", { class: "lead" }, "A simulated table hides one effect, or none. Say which: three points at the first guess, one less with each wrong one. A riddle takes the place of the recording; the models of that one are kept in the folder.");
    if (!riddle) return [heading("A riddle"), lead, another];
    const told = riddle.guesses.length ? [element("p", {}, `Guessed: ${riddle.guesses.join(", ")}.`)] : [];
    if (riddle.points != null) {
      const right = riddle.points > 0;
      return [heading("The riddle"), ...told, element("p", { class: "answer" }, element("b", {}, right ? "Right: " : "It was: "), `${riddle.hidden}. ${riddle.points} ${riddle.points === 1 ? "point" : "points"} (seed ${riddle.seed}).`), another];
    }
    const pick = element("select", { "aria-label": "guess" }, option("nothing", "nothing is hidden"), ...effects.filter((effect) => !effect.name.includes(":")).map((effect) => option(effect.name, `${effect.name}: ${effect.title}`)));
    return [heading("The riddle"), lead, ...told, element("p", { class: "fields" }, field("It hides", pick), button("That is it", () => send("/api/guess", { effect: pick.value }), { class: "main" }), button("Give up", () => send("/api/guess", { effect: null })), element("span", {}, `worth ${riddle.left}`))];
  });
}

// The check of the recording that the models are of; it takes the recording to be in memory.
let checked = null;
async function drawData(state) {
  if (!state.models.length || checked === state.data) return;
  checked = state.data;
  try {
    const { html } = await ask("/api/data");
    if (checked === state.data) fill(part("data"), html);
  } catch (refusal) {
    checked = null;
    throw refusal;
  }
}
