// The plot, which the tool draws in advance, and the card of the selected point.
const pointLink = (id, text = rows.get(id).label) =>
  el("button", { type: "button", class: "point-link", title: "Show in the plot", onclick: () => { pin(id); byId("plot").scrollIntoView(); } }, text);

function showPlot() {
  // The tool composes the SVG and escapes all text in it.
  byId("figure").innerHTML = plots[chosen.input][chosen.metric.key];
  const svg = byId("figure").firstElementChild;
  svg.setAttribute("role", "group");
  const cost = (point) => rows.get(point.dataset.row).cost_ms;
  const points = [...svg.querySelectorAll(".point")].sort((a, b) => cost(a) - cost(b));
  points.forEach((point, i) => {
    const row = rows.get(point.dataset.row);
    // All points share one stop of the Tab key; arrow keys move between them.
    point.setAttribute("tabindex", i === 0 ? 0 : -1);
    point.setAttribute("role", "button");
    point.setAttribute("aria-label", `${row.label}: ${withUnit(chosen.metric, row.values[chosen.metric.key])}, ${ms(row.cost_ms)} ms`);
    point.addEventListener("pointerenter", () => showCard(row));
    point.addEventListener("pointerleave", () => showCard(rows.get(chosen.pinned)));
    point.addEventListener("focus", () => showCard(row));
    point.addEventListener("click", () => pin(row.id));
    point.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      if (step) {
        const next = points[(i + step + points.length) % points.length];
        point.setAttribute("tabindex", -1);
        next.setAttribute("tabindex", 0);
        next.focus();
      } else if (event.key === "Enter" || event.key === " ") pin(row.id);
      else return;
      event.preventDefault();
    });
  });
  pin(ofInput().some((row) => row.id === chosen.pinned) ? chosen.pinned : firstPinned());
}

// The point with the best quality on the frontier.
function firstPinned() {
  const best = ofInput().filter((row) => row.frontier.includes(chosen.metric.key));
  return (best.at(-1) ?? ofInput()[0])?.id;
}

function pin(id) {
  chosen.pinned = id;
  for (const point of document.querySelectorAll(".pareto .point")) point.classList.toggle("pinned", point.dataset.row === id);
  for (const line of document.querySelectorAll("tr[data-row]")) line.classList.toggle("chosen", line.dataset.row === id);
  showCard(rows.get(id));
}

function showCard(row) {
  if (!row) return byId("card").replaceChildren();
  const line = (name, ...value) => el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, ...value));
  const figure = (metric) => {
    const spread = row.spread[metric.key];
    const seeds = spread && el("span", { class: "small" }, ` (${fixed(spread[0], metric.digits)} to ${fixed(spread[1], metric.digits)})`);
    return line(metric.title, withUnit(metric, row.values[metric.key]), seeds);
  };
  const { median, p25, p75 } = row.pass_ms;
  const lines = [
    line("Cost", `${ms(row.cost_ms)} ms`),
    line("Pass", `${ms(median)} ms`, el("span", { class: "small" }, ` (quartiles ${ms(p25)} to ${ms(p75)})`)),
    line("Renderer", row.render_ms == null ? "unknown" : `${ms(row.render_ms)} ms`),
    line("Copy of the same size", `${ms(row.copy_ms)} ms`),
    line("Samples", percent(row.samples_share)),
    line("Bytes per pixel", `${row.bytes_per_pixel ?? "—"} moved, ${fixed(row.memory_bytes_per_pixel, 1)} kept`),
    ...metrics.map(figure),
    line("Seeds", String(row.seeds)),
  ];
  const star = row.frontier.includes(chosen.metric.key) ? el("span", { class: "star", title: "on the frontier" }, "★ ") : null;
  byId("card").replaceChildren(
    el("h3", {}, star, row.label),
    el("table", {}, ...lines),
    el("p", {}, "Command ", copyButton(row.command, "command"), el("pre", {}, row.command)),
    el("p", {}, "Settings in Rust ", copyButton(row.rust, "settings"), el("pre", {}, row.rust)),
  );
}
