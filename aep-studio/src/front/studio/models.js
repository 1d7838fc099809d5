// The tree of models, and the parameters of the chosen one.

const pathOf = (state, id) => {
  const path = [];
  for (let at = state.models.find((model) => model.id === id); at && !path.includes(at); at = state.models.find((model) => model.id === at.parent)) path.unshift(at);
  return path;
};

// Models in the order of the tree; only branches are indented.
function ordered(state) {
  const rows = [];
  const visit = (model, depth) => {
    rows.push({ model, depth });
    const children = state.models.filter((other) => other.parent === model.id);
    children.forEach((child, k) => visit(child, depth + (children.length > 1 && k > 0 ? 1 : 0)));
  };
  state.models.filter((model) => model.parent == null).forEach((model) => visit(model, 0));
  return rows;
}

function bar(times, largest) {
  const track = element("span", { class: "track" }, element("span", { class: "held" }), element("span", { class: "floor" }));
  track.children[0].style.width = `${100 * Math.min((times ?? 0) / largest, 1)}%`;
  track.children[1].style.left = `${100 / largest}%`;
  return track;
}

function drawModels(state, compared) {
  const job = state.job;
  draw("models", [state.models.map(({ id, name, times, gain }) => [id, name, times, gain]), state.chosen, compared, job?.times != null && [job.task.from, job.times, job.said]], () => {
    if (!state.models.length) return [];
    const live = job?.times != null ? job : null;
    const largest = Math.max(1, ...state.models.map((model) => model.times ?? 0), live?.times ?? 0);
    const path = pathOf(state, state.chosen);
    const row = ({ model, depth }) => {
      const chosen = model.id === state.chosen;
      const choose = element(
        "button",
        { type: "button", class: "node-name", title: `${model.said}. ${model.effects.join(" + ")}`, "aria-pressed": String(chosen), onclick: () => attempt(() => send("/api/choose", { model: model.id })) },
        model.name,
      );
      const beside = element("button", { type: "button", class: "with", title: "compare with the chosen model", "aria-label": `compare ${model.name} with the chosen model`, "aria-pressed": String(model.id === compared), onclick: () => compareWith(model.id === compared ? null : model.id) }, "vs");
      const made = element("div", { class: `rung node${chosen ? " chosen" : ""}${path.includes(model) ? " on-path" : ""}`, "data-model": model.id }, choose, bar(model.times, largest), element("span", { class: "value" }, model.times_said ? `${model.times_said} ×` : "–"), element("span", { class: "gain", title: "held-out log-likelihood gained over the model before it, nats" }, model.gain ?? ""), chosen ? element("span", {}) : beside);
      made.style.paddingLeft = `${4 + 14 * depth}px`;
      return made;
    };
    const rows = ordered(state).map(row);
    if (live) rows.push(element("div", { class: "rung node live-fit" }, element("span", { class: "node-name" }, live.said), bar(live.times, largest), element("span", { class: "value" }, `${live.times_said} ×`), element("span", {}), element("span", {})));
    return [
      element("div", { class: "legend" }, element("h3", {}, "Models"), element("span", {}, element("i", { class: "c1" }), "prediction error"), element("span", {}, element("i", { class: "floor" }), "what the sensors make")),
      element("div", { class: "ladder" }, ...rows),
    ];
  });
}

function drawParameters(state) {
  const model = state.models.find((one) => one.id === state.chosen);
  draw("parameters", model && [model.id, model.parameters], () => {
    if (!model) return [];
    const rows = model.parameters.map((parameter) => {
      const value = element("input", { type: "number", step: "any", value: Number(parameter.number.toPrecision(6)), "aria-label": `value of ${parameter.name}, ${parameter.unit ?? "SI"}` });
      const task = (wanted) => send("/api/task", { task: "fix", from: model.id, parameter: parameter.name, value: wanted });
      const typed = () => {
        if (Number.isNaN(value.valueAsNumber)) throw new Refusal({ what: `say at which value ${parameter.name} is fixed`, hint: "a number, in SI units" });
        return value.valueAsNumber;
      };
      const act = parameter.fixed ? button("Free it", () => task(null)) : button("Fix it", () => task(typed()));
      return element(
        "tr",
        {},
        element("th", { scope: "row" }, parameter.name),
        element("td", { class: "num" }, parameter.value),
        element("td", {}, parameter.fixed ? "fixed" : parameter.interval),
        element("td", { class: "fix" }, parameter.fixed ? "" : value, parameter.unit ?? "", " ", act),
      );
    });
    const removable = model.effects.map((effect) => button(`− ${effect}`, () => send("/api/task", { task: "remove", from: model.id, effect }), { title: `fit without ${effect}` }));
    return [
      heading(`Parameters of ${model.name}`),
      element("p", { class: "lead" }, `${model.said}. Intervals are 95 %; "not determined" means that this recording does not say. A value is fixed in SI units.`),
      element("div", { class: "scroll" }, element("table", {}, element("thead", {}, element("tr", {}, ...["Parameter", "Value", "95 % interval", "Fix at"].map((name) => element("th", { scope: "col" }, name)))), element("tbody", {}, ...rows))),
      element("p", { class: "remove" }, "Fit without an effect: ", ...removable),
    ];
  });
}
