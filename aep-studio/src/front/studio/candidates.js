// What may be missing: the candidates beside the chosen model, and every other effect.

const FEW = 8;
const add = (state, effect) => send("/api/task", { task: "add", from: state.chosen, effect });

function drawCandidates(state, effects) {
  const found = state.suggestions;
  draw("candidates", [state.chosen, found, state.said, effects.length], () => {
    if (state.chosen == null) return [];
    const model = state.models.find((one) => one.id === state.chosen);
    const rows = found?.rows ?? [];
    const row = (candidate) =>
      element(
        "div",
        { class: `candidate${candidate.likely ? " likely" : ""}`, "data-effect": candidate.effect },
        button("Add", () => add(state, candidate.effect), { class: candidate === rows[0] && candidate.likely ? "main" : "", "aria-label": `add ${candidate.effect}` }),
        element("span", { class: "what", title: [candidate.title, candidate.equation, candidate.shows].filter(Boolean).join(". ") }, element("b", {}, candidate.effect), element("small", {}, candidate.size || candidate.title || "")),
        element("span", { class: "gain" }, candidate.gain ? `${candidate.gain} nats` : "–", element("small", {}, `p ${candidate.p}`)),
      );
    const list = found
      ? [
          element("p", { class: "lead" }, found.summary),
          ...rows.slice(0, FEW).map(row),
          rows.length > FEW ? element("details", {}, element("summary", {}, `${rows.length - FEW} that promise less`), ...rows.slice(FEW).map(row)) : "",
          ...(found.missing ? [element("p", { class: "lead" }, `The force that the model lacks: ${found.missing}.`)] : []),
          ...(found.places.length ? [element("details", {}, element("summary", {}, "Where it fails"), element("ul", {}, ...found.places.map((place) => element("li", {}, place))))] : []),
          ...found.notes.map((note) => element("p", { class: "lead" }, note)),
        ]
      : [element("p", { class: "lead" }, "Not looked for yet beside this model. "), element("p", {}, button("Try every effect", () => send("/api/task", { task: "suggest", from: state.chosen })))];
    const pick = element("select", { "aria-label": "effect" }, ...effects.filter((effect) => !model.effects.includes(effect.name)).map((effect) => option(effect.name, `${effect.name}: ${effect.title}`)));
    const said = state.said ? [element("details", { class: `said${state.said.complete ? "" : " incomplete"}`, open: true }, element("summary", {}, element("b", {}, `The last search: ${state.said.verdict}`)), element("p", {}, state.said.summary), ...state.said.notes.map((note) => element("p", { class: "lead" }, note)))] : [];
    return [...said, element("h3", {}, "What is missing?"), ...list, element("p", { class: "any" }, pick, " ", button("Add it", () => add(state, pick.value)))];
  });
}
