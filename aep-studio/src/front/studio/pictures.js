// The pictures of a recording with the models up to the chosen one, or with two models.

const pictures = { key: null, state: null };

const TEMPLATE = () => [
  element("div", { class: "steer" }, element("div", { class: "models", "data-show": "models" }), element("div", { class: "choices", "data-show": "choices" })),
  element("div", { "data-show": "fit" }),
  element("div", { "data-show": "residual" }),
  element("div", { class: "region", "data-show": "region", "aria-live": "polite" }),
  element("div", { class: "moments", "data-show": "moments" }),
  element("div", { class: "pair" }, element("div", { "data-show": "profile" }), element("div", { "data-show": "map" }), element("div", { "data-show": "remains", class: "remains" })),
];

// Draws what is chosen; what was zoomed into stays so, and an effect more is seen to take its part of the error away.
async function drawPictures(state, compared) {
  if (state.chosen == null) return;
  const key = `${state.data} ${state.chosen} ${compared}`;
  if (pictures.key === key) return;
  pictures.key = key;
  const asked = `of=${state.chosen}${compared == null ? "" : `&with=${compared}`}`;
  const raw = await ask(`/api/course?${asked}`);
  // Something else was chosen meanwhile.
  if (pictures.key !== key) return;
  const before = pictures.state;
  const same = before?.data === state.data;
  const scale = same ? { ...before.screen.left.plot.scales.x } : null;
  const wasCompared = before?.screen.compared ?? 0;
  const fresh = element("div", { class: "pictures" }, ...TEMPLATE());
  part("pictures").replaceChildren(fresh);
  const made = screen(fresh, raw);
  forgetGone();
  pictures.state = { screen: made, data: state.data, chosen: state.chosen };
  if (same && wasCompared < made.course.compared.length && wasCompared !== made.compared) fresh.querySelectorAll(".choice button")[wasCompared]?.click();
  if (scale?.min != null) show(made.left, scale.min, scale.max);
  const grew = same && compared == null && state.models.find((model) => model.id === state.chosen)?.parent === before.chosen;
  if (grew && !matchMedia("(prefers-reduced-motion: reduce)").matches) {
    choose(made, made.course.models.length - 2);
    setTimeout(() => fresh.isConnected && choose(made, made.course.models.length - 1), 450);
  }
  // What takes longer comes after the pictures.
  const { html } = await ask(`/api/remains?${asked}`);
  if (fresh.isConnected) fill(fresh.querySelector("[data-show=remains]"), html);
}
