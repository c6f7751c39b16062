/* Figures stand in this page as deflated SVG: they are inflated once it has loaded, and saved as they are. */
"use strict";
quatspline.figures = (() => {
  const { read, inflated, save } = quatspline.data;

  async function show(picture) {
    const svg = await inflated(read(`picture-${picture.dataset.picture}`), "image/svg+xml");
    picture.src = URL.createObjectURL(svg);
    picture.closest("figure").querySelector("button.svg").addEventListener("click", () => save(`${picture.dataset.picture}.svg`, svg.type, svg));
    await picture.decode();
  }

  /* One after the other, so that the page stays at hand meanwhile. */
  async function showAll() {
    for (const picture of document.querySelectorAll("img[data-picture]")) await show(picture);
  }

  return new Promise((done) => window.addEventListener("load", () => showAll().then(done)));
})();
