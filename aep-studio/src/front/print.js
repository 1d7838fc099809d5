// On paper everything is unfolded, and plots have the colours of paper.

const toPaper = () => {
  document.querySelectorAll("details:not([open])").forEach((folded) => {
    folded.open = true;
    folded.dataset.printed = "yes";
  });
  document.documentElement.classList.add("paper");
  forgetColours();
};
const fromPaper = () => {
  document.querySelectorAll("details[data-printed]").forEach((opened) => {
    opened.open = false;
    delete opened.dataset.printed;
  });
  document.documentElement.classList.remove("paper");
  forgetColours();
};
addEventListener("beforeprint", toPaper);
addEventListener("afterprint", fromPaper);
