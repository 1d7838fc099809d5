// A part of the recording looked at alone: a stretch of time, a regime, cells of the map. All pictures of the residual then show
// that part, at its size, with what share of the residual it is.

const everywhere = () => true;

// What a model leaves of the samples that are compared and hold; NaN elsewhere.
function residualWhere(state, model, holds) {
  const { residuals, leftOut } = state.course.compared[state.compared];
  return residuals[model].map((value, k) => (leftOut[k] < 0 && holds(k) ? value : NaN));
}

// The same in the part that is looked at.
function residualOf(state, model) {
  const key = `${state.compared} ${model}`;
  if (!state.residuals.has(key)) state.residuals.set(key, residualWhere(state, model, state.region?.holds ?? everywhere));
  return state.residuals.get(key);
}

// Looks at a part, {name, holds(sample)}, or at all of it again.
function lookAt(state, region) {
  state.region = region;
  state.residuals.clear();
  choose(state, state.model);
}

// A stretch from one sample to another, shown with a little of what is around it.
function lookAtStretch(state, from, to, name) {
  const { time } = state.course;
  const around = Math.max(0.1 * (time[to] - time[from]), 2 * (time[1] - time[0]));
  lookAt(state, { name: `${name ? `${name}, ` : ""}${number(time[from], 5)} to ${number(time[to], 5)} s`, holds: (k) => k >= from && k <= to });
  show(state.left, time[from] - around, time[to] + around);
}

// The uninterrupted stretch of one regime around an instant.
function lookAround(state, instant) {
  const { time, piece, regime, regimes } = state.course;
  let at = 0;
  let end = time.length - 1;
  while (at < end) {
    const middle = (at + end) >> 1;
    if (time[middle] < instant) at = middle + 1;
    else end = middle;
  }
  const same = (k) => k >= 0 && k < time.length && piece[k] === piece[at] && regime[k] === regime[at];
  let [from, to] = [at, at];
  while (same(from - 1)) from--;
  while (same(to + 1)) to++;
  lookAtStretch(state, from, to, regimes[regime[at]]);
}

// Sum of squares and number of what a model leaves over all samples that are compared and hold.
function squares(state, model, holds) {
  const known = residualWhere(state, model, holds).filter(isFinite);
  return { sum: known.reduce((sum, value) => sum + value ** 2, 0), count: known.length };
}

const percent = (share) => (isFinite(share) ? `${number(100 * share, share < 0.0995 ? 2 : 3)} %` : "–");

// What part it is, how large its residual is and what share of all.
function drawRegion(state, host) {
  const { region, course, model } = state;
  host.hidden = !region;
  if (!region) return;
  const { unit } = course.compared[state.compared];
  const [here, all] = [region.holds, everywhere].map((holds) => squares(state, model, holds));
  const rms = ({ sum, count }) => quantity(Math.sqrt(sum / count), unit);
  const first = model > 0 ? ` (${course.models[0].name} ${rms(squares(state, 0, region.holds))})` : "";
  const told = here.count
    ? ` ${percent(here.count / all.count)} of the samples, ${percent(here.sum / all.sum)} of the squared residual; ${rms(here)} rms here${first}, ${rms(all)} over all`
    : " is not compared: see the reason under the cursor";
  const back = element("button", { type: "button", onclick: () => whole(state.left) }, "All of it");
  host.replaceChildren(element("b", {}, region.name), told, " ", back);
}

// Regimes as buttons, each with its share of the squared residual.
function regimeButtons(state) {
  const { regimes, regime } = state.course;
  const buttons = regimes.map((name, index) => {
    const share = element("small");
    const button = element("button", { type: "button", "aria-pressed": "false", title: "look at the residual in this regime alone; the number is its share of the squared residual drawn here" }, element("i", { class: REGIME_TINTS[index % 7] }), name, share);
    button.addEventListener("click", () => {
      const chosen = state.region?.regime === index;
      whole(state.left);
      if (!chosen) lookAt(state, { name, regime: index, holds: (k) => regime[k] === index });
    });
    return { button, share, holds: (k) => regime[k] === index, index };
  });
  state.tellRegimes = () => {
    const all = squares(state, state.model, everywhere).sum;
    for (const { button, share, holds, index } of buttons) {
      share.textContent = percent(squares(state, state.model, holds).sum / all);
      button.setAttribute("aria-pressed", String(state.region?.regime === index));
    }
  };
  return buttons.map(({ button }) => button);
}
