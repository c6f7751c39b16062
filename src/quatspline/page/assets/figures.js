/* Figures are images whose source is the SVG itself: downloading decodes it. */
"use strict";
document.querySelectorAll("button.svg").forEach((button) => {
  const picture = button.closest("figure").querySelector("img");
  button.addEventListener("click", () => {
    const raw = atob(picture.src.split(",")[1]);
    const bytes = Uint8Array.from(raw, (c) => c.charCodeAt(0));
    quatspline.data.save(picture.dataset.file, "image/svg+xml", bytes);
  });
});
