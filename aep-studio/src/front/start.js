// Begins when the page stands.

document.documentElement.classList.add("scripted");
document.querySelectorAll("section.screen").forEach((section) => screen(section));
watchFigures(document);

// What is folded is printed, too, and opened where a link leads into it.
const unfold = () => document.querySelectorAll("details:not([open])").forEach((folded) => {
  folded.open = true;
  folded.dataset.printed = "yes";
});
const fold = () => document.querySelectorAll("details[data-printed]").forEach((opened) => {
  opened.open = false;
  delete opened.dataset.printed;
});
addEventListener("beforeprint", unfold);
addEventListener("afterprint", fold);
const reach = () => {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  if (target.tagName === "DETAILS") target.open = true;
  target.scrollIntoView();
};
addEventListener("hashchange", reach);
reach();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", forgetColours);
