/* Everything that this page shows comes to life. */
"use strict";
{
  const tables = new Map();
  /* Tables inside a folded part are built when it opens. */
  const build = (place) => tables.has(place.dataset.table) || tables.set(place.dataset.table, new quatspline.Table(place));
  document.querySelectorAll("div.table").forEach((place) => {
    const fold = place.closest("details");
    if (fold.open) build(place);
    else fold.addEventListener("toggle", () => build(place), { once: true });
  });
  quatspline.tables = tables;

  const chooser = document.getElementById("chooser");
  if (chooser) quatspline.chooser = new quatspline.Chooser(chooser, quatspline.data.read("choices"));

  document.querySelectorAll("[data-plot]").forEach((place) => new quatspline.TablePlot(place));
  const motions = (quatspline.data.read("scenes") || []).map((packed) => new quatspline.Motion(packed));
  const player = document.getElementById("player");
  if (player && motions.length) {
    document.querySelectorAll("[data-motion]").forEach((place) => new quatspline.MotionPlot(place, motions));
    quatspline.player = new quatspline.Player(player, motions);
  }

  const drawn = document.getElementById("drawn");
  if (drawn && motions.length) {
    const { body, knots, keyframes } = motions[0];
    quatspline.drawing = new quatspline.Drawing(drawn, body, knots, keyframes);
  }

  const recorded = document.getElementById("replay");
  if (recorded) quatspline.replay = new quatspline.Replay(recorded, quatspline.data.read("replays").map((packed) => new quatspline.Recording(packed)));

  document.querySelectorAll("a.quote").forEach((link) => link.addEventListener("click", (event) => {
    const place = document.getElementById(`table-${link.dataset.table}`);
    if (!place) return;
    event.preventDefault();
    build(place);
    history.replaceState(null, "", link.getAttribute("href"));
    tables.get(link.dataset.table).cite(JSON.parse(link.dataset.row), link.dataset.column);
  }));

  /* On a narrow screen the contents start folded. */
  if (window.innerWidth < 1120) document.querySelector(".contents details").open = false;
}
