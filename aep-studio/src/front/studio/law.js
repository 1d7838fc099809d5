// A law of one's own: typed, drawn at once beside what the model leaves, added.

const GIVEN = new Set(["x", "v", "a", "s", "t", "F", "pi", "PI", "TAU", "E"]);

// Names of a formula that are neither functions nor given: its parameters. The e of 2e3 is none.
function namesOf(text) {
  const names = new Set();
  for (const [, name, after] of text.matchAll(/(?<![\w.])([A-Za-z_]\w*)\s*(\(?)/g)) if (!after && !GIVEN.has(name)) names.add(name);
  return [...names];
}

// The curve stands beside what the chosen model leaves.
const typed = { curve: null, beside: null };

function drawLaw(state) {
  if (typed.beside !== state.chosen) typed.curve?.();
  typed.beside = state.chosen;
  draw("law", [state.data, state.chosen != null], () => {
    if (state.chosen == null) return [];
    const name = element("input", { value: "my-law", "aria-label": "name", autocomplete: "off" });
    const kind = element("select", { "aria-label": "kind" }, option("force", "a force that resists the motion"), option("level", "adds to the friction level"));
    const text = element("input", { class: "wide", placeholder: "a*sin(2*pi*x/p)", "aria-label": "law", autocomplete: "off", spellcheck: "false" });
    const rows = element("tbody");
    const said = element("p", { class: "warn", "aria-live": "polite" });
    const host = element("div");
    let parameters = {};
    const law = () => ({ name: name.value.trim(), [kind.value]: text.value, parameters });
    const fields = () => {
      const wanted = namesOf(text.value);
      if (Object.keys(parameters).join() === wanted.join()) return;
      parameters = Object.fromEntries(wanted.map((one) => [one, parameters[one] ?? { unit: "1", low: -100, high: 100, default: 1, linear: false }]));
      rows.replaceChildren(
        ...wanted.map((one) => {
          const parameter = parameters[one];
          const number = (key) => element("input", { type: "number", step: "any", value: parameter[key], "aria-label": `${key} of ${one}`, oninput: (event) => (parameter[key] = Number(event.target.value)) });
          return element(
            "tr",
            {},
            element("th", { scope: "row" }, one),
            element("td", {}, element("input", { value: parameter.unit, size: 5, "aria-label": `unit of ${one}`, oninput: (event) => (parameter.unit = event.target.value.trim()) })),
            ...["default", "low", "high"].map((key) => element("td", {}, number(key))),
            element("td", {}, element("input", { type: "checkbox", checked: parameter.linear, "aria-label": `${one} is linear`, oninput: (event) => (parameter.linear = event.target.checked) })),
          );
        }),
      );
    };
    let asked = 0;
    const curve = settled(async () => {
      if (!text.value.trim() || page.state.chosen == null) return;
      const mine = ++asked;
      try {
        const got = await send("/api/law", { law: law(), from: page.state.chosen });
        if (mine !== asked) return;
        said.textContent = "";
        const series = [{ label: "the law", colour: "c2", width: 2 }, { label: "what the model leaves (mean)", colour: "c1", dots: true }];
        const fresh = element("div");
        host.replaceChildren(fresh);
        chart(fresh, { title: "The law along the recorded motion", x: { label: got.along, unit: got.unit ?? "" }, y: { label: "force", unit: got.of }, data: [got.at, got.law, got.left], series, height: 220 });
        forgetGone();
      } catch (refusal) {
        if (mine === asked) said.textContent = [refusal.message, refusal.hint].filter(Boolean).join(". ");
      }
    }, 120);
    typed.curve = curve;
    const body = element(
      "div",
      { oninput: () => { fields(); curve(); } },
      element("div", { class: "fields" }, field("Name", name), field("Law", text), field("It is", kind)),
      element("div", { class: "scroll" }, element("table", { class: "mapping" }, element("thead", {}, element("tr", {}, ...["Parameter", "Unit", "Value", "Least", "Largest", "Linear"].map((one) => element("th", { scope: "col" }, one)))), rows)),
      said,
    );
    return [
      heading("A law of your own"),
      element("p", { class: "lead" }, "x position, v velocity, a acceleration, s sign of v, t time, F force of the drive; other names are parameters. A linear parameter is one that the law is proportional to."),
      body,
      host,
      element("p", {}, button("Add it to the model", () => send("/api/effect", { law: law(), from: page.state.chosen }), { class: "main" })),
    ];
  });
}
