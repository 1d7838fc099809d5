// On paper everything is unfolded, and plots have the colours of paper.

const toPaper = () => {
  document.querySelectorAll("details:not([open])").forEach((folded) => {
    folded.open = true;
    folded.dataset.printed = "yes";
  });
};
const fromPaper = () => {
  document.querySelectorAll("details[data-printed]").forEach((opened) => {
    opened.open = false;
    delete opened.dataset.printed;
  });
};
addEventListener("beforeprint", toPaper);
addEventListener("afterprint", fromPaper);
