// Begins when the page stands.

document.documentElement.classList.add("scripted");
watchScreens();
watchFigures(document);

// What is folded is opened where a link leads to it.
const reach = () => {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  if (target.tagName === "DETAILS") target.open = true;
  target.scrollIntoView();
};
addEventListener("hashchange", reach);
reach();
