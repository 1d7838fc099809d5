// Small pieces of the page. Text is always text: nothing of a file becomes markup.

const part = (name) => document.querySelector(`[data-part=${name}]`);

const button = (label, act, more = {}) => element("button", { type: "button", onclick: () => attempt(act), ...more }, label);

// Does something that may be refused, and says why it was.
async function attempt(act) {
  part("notices").replaceChildren();
  try {
    await act();
  } catch (refusal) {
    notice(refusal);
  }
}

// What went wrong, where, and how to mend it.
function notice({ message, what, place, hint }) {
  const lines = [element("b", {}, message ?? what), place ? ` (${place})` : "", hint ? element("p", {}, hint) : ""];
  part("notices").replaceChildren(element("div", { class: "doubt", role: "alert" }, ...lines, element("button", { type: "button", onclick: (event) => event.target.parentElement.remove() }, "Close")));
}

const field = (label, input, more = "") => element("label", { class: "field" }, element("span", {}, label), input, more);

const option = (value, label = value, selected = false) => element("option", { value, selected }, label);

// Waits until nothing has happened for a moment.
function settled(act, wait = 250) {
  let timer = 0;
  return (...given) => {
    clearTimeout(timer);
    timer = setTimeout(() => act(...given), wait);
  };
}

// What the studio made as HTML, in which nothing of a file is markup; its drawings become plots.
function fill(host, html) {
  host.innerHTML = html ?? "";
  forgetGone();
  watchFigures(host);
}

const heading = (text) => element("h2", {}, text);

// Draws a part anew only where what it shows has changed, so that a field keeps what is typed into it.
const shown = new Map();
function draw(name, content, make) {
  const key = JSON.stringify(content);
  if (shown.get(name) === key) return;
  shown.set(name, key);
  const host = part(name);
  const children = make();
  host.hidden = children.length === 0;
  host.replaceChildren(...children);
}
