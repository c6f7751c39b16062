// Displayed formulas that are wider than the page, after their lines were broken, are set smaller; what would not be
// legible then scrolls.
const LEAST = 0.62;

function fit() {
  for (const box of document.querySelectorAll(".equation .parts")) {
    box.style.fontSize = "";
    const ratio = box.clientWidth / box.scrollWidth;
    if (ratio < 1) box.style.fontSize = `${Math.max(LEAST, 0.99 * ratio) * 100}%`;
  }
}

addEventListener("load", fit);
addEventListener("resize", fit);
