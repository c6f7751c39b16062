/* The light and the dark look: the system's preference, or what the reader switched to. */
"use strict";
quatspline.theme = (() => {
  const KEY = "quatspline-look";
  const button = document.getElementById("look");
  const preferred = window.matchMedia("(prefers-color-scheme: dark)");
  const followers = [];

  /* Pages opened from a file may be denied a memory. */
  function remembered() {
    try { return localStorage.getItem(KEY); } catch { return null; }
  }
  function remember(look) {
    try { localStorage.setItem(KEY, look); } catch { /* the look lasts as long as the page */ }
  }

  /* Colours of the look; asking for a computed style costs more than all else that a frame draws. */
  const colors = new Map();
  function color(name) {
    if (!colors.has(name)) colors.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
    return colors.get(name);
  }

  function apply(look) {
    colors.clear();
    document.documentElement.dataset.look = look;
    button.setAttribute("aria-pressed", String(look === "dark"));
    followers.forEach((follow) => follow(look));
  }

  const look = () => document.documentElement.dataset.look;
  button.addEventListener("click", () => {
    const next = look() === "dark" ? "light" : "dark";
    remember(next);
    apply(next);
  });
  preferred.addEventListener("change", () => remembered() || apply(preferred.matches ? "dark" : "light"));
  /* Paper is white. */
  let before = null;
  window.addEventListener("beforeprint", () => { before = look(); apply("light"); });
  window.addEventListener("afterprint", () => before && apply(before));
  apply(remembered() || (preferred.matches ? "dark" : "light"));
  return { color, look, follow: (f) => followers.push(f) };
})();
