function showAll() {
  showPlot();
  showEqual();
  showPrices();
  showCompare();
  showConvergences();
  showPoints();
}

function choice(id, options, of) {
  const list = byId(id);
  list.append(...options.map(([name], i) => el("option", { value: i }, name)));
  list.addEventListener("change", () => { of(options[list.value][1]); showAll(); });
}

if (inputs.length) {
  const known = (m) => table.rows.some((row) => row.values[m.key] != null);
  const figures = metrics.filter(known);
  chosen.metric = figures[0] ?? metrics[0];
  choice("input", inputs.map((input) => [input, input]), (input) => (chosen.input = input));
  choice("metric", figures.map((m) => [`${headed(m)} (${direction(m)})`, m]), (m) => (chosen.metric = m));
  showAll();
}
