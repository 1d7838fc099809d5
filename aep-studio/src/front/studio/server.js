// Requests to the studio. What changes something carries the token of the page.

let token = document.querySelector("meta[name=aep-token]").content;

// A studio that was started again has another token; its page has it.
async function renew() {
  const text = await fetch("/").then((response) => response.text());
  token = new DOMParser().parseFromString(text, "text/html").querySelector("meta[name=aep-token]").content;
}

class Refusal extends Error {
  constructor({ what, place, hint }) {
    super(what);
    Object.assign(this, { place, hint });
  }
}

async function answered(response) {
  const answer = await response.json().catch(() => ({ error: { what: `the studio answered with ${response.status}` } }));
  if (!response.ok) throw new Refusal(answer.error ?? { what: `the studio answered with ${response.status}` });
  return answer;
}

const request = (path, options) =>
  fetch(path, options).then(answered, () => {
    throw new Refusal({ what: "the studio does not answer", hint: "start it again in the same folder: nothing but a fit in progress is lost" });
  });

const ask = (path) => request(path);
const send = (path, content = {}) =>
  request(path, { method: "POST", headers: { "x-aep-token": token, "content-type": "application/json" }, body: JSON.stringify(content) });
const sendFile = (path, file) => request(path, { method: "POST", headers: { "x-aep-token": token }, body: file });

// Hears what happens. A page that nobody looks at listens to nothing: browsers keep few connections.
function listen(heard, lost) {
  let source = null;
  let gone = false;
  const open = () => {
    if (document.hidden || source) return;
    source = new EventSource("/api/events");
    source.onopen = async () => {
      // It may have gone again meanwhile; then this is tried again.
      if (gone && (await renew().catch(() => "away")) === "away") return;
      gone = false;
      heard({ changed: true });
    };
    source.onmessage = ({ data }) => heard(JSON.parse(data));
    source.onerror = () => {
      if (source.readyState === EventSource.CLOSED) {
        source = null;
        setTimeout(open, 1000);
      }
      gone = true;
      lost();
    };
  };
  document.addEventListener("visibilitychange", () => {
    if (!document.hidden) return open();
    source?.close();
    source = null;
  });
  open();
}
