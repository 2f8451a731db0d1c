// Tables: equal time and equal quality, cost of switches, convergence, all points.
function showEqual() {
  const metric = chosen.metric;
  const sections = equal[chosen.input][metric.key];
  const most = Math.max(...sections.map((s) => s.points));
  const parts = sections.map((section) => {
    const of = section.samples_share == null ? "whole frame" : "pass alone";
    const time = lines(section, section.equal_time, `Budget, ms (${of})`, (line) => `≤ ${threeDigits(line.bound)}`,
      (cell) => withUnit(metric, cell.value), (a, b) => metric.more_is_better ? b.value - a.value : a.value - b.value,
      `The best ${metric.title} within a budget (${direction(metric)})`);
    const quality = lines(section, section.equal_quality, headed(metric), (line) => `${metric.more_is_better ? "≥" : "≤"} ${fixed(line.bound, metric.digits)}`,
      (cell) => `${ms(cell.cost_ms)} ms`, (a, b) => a.cost_ms - b.cost_ms, `The shortest time (${of}) for a given ${metric.title}`);
    const both = el("div", { class: "beside" }, time, quality);
    if (section.samples_share == null) return both;
    const share = `${percent(section.samples_share)} of the samples (${section.points} points)`;
    return el("details", { open: section.points === most }, el("summary", {}, share), both);
  });
  const note = sections.some((s) => s.samples_share != null)
    ? "The renderer's time is unknown, so points are compared at equal shares of the samples; set --renderer-ms to compare all of them." : null;
  byId("equal").replaceChildren(
    el("p", { class: "faint" }, "Bold with ★: the best method of the line. —: no point of the method is within the bound. ", note),
    ...(parts.length ? parts : [el("p", {}, `${metric.title} was not measured for this input.`)]),
  );
}

function lines(section, all, heading, bound, text, order, caption) {
  const body = all.map((line) => {
    const best = line.cells.filter(Boolean).sort(order)[0];
    const cells = line.cells.map((cell) => {
      if (!cell) return el("td", { class: "number" }, "—");
      const wins = cell === best || (best && order(cell, best) === 0);
      return el("td", { class: wins ? "number winner" : "number" }, wins ? "★ " : "", text(cell),
        el("div", { class: "small" }, pointLink(cell.row, withoutMethod(rows.get(cell.row)))));
    });
    return el("tr", {}, el("th", { scope: "row", class: "number" }, bound(line)), ...cells);
  });
  const head = el("tr", {}, el("th", {}, heading), ...section.methods.map((m) => el("th", { class: "number" }, m)));
  return el("div", { class: "wide" }, el("h3", {}, caption), el("table", {}, el("thead", {}, head), el("tbody", {}, ...body)));
}

// Labels in a method's column do not repeat its name.
const withoutMethod = (row) => row.label.startsWith(`${row.method}, `) ? row.label.slice(row.method.length + 2) : row.label;

function change(before, after, text, how) {
  const mark = { better: "▲ better", worse: "▼ worse", same: "same", seeds: "within seed variation", "": "" }[how];
  return el("td", { class: "number" }, `${text(before)} → ${text(after)}`, el("div", { class: `small ${how}` }, mark));
}

function showPrices() {
  const prices = table.prices.filter((p) => p.input === chosen.input);
  if (!prices.length) return byId("prices").replaceChildren(el("tbody", {}, el("tr", {}, el("td", {}, "No switch was measured for this input."))));
  const less = (digits) => ({ digits, more_is_better: false });
  const time = (p) => {
    const [before, after] = p.pass_ms;
    const { median, p25, p75 } = p.time_ratio;
    const how = p75 < 1 ? "better" : p25 > 1 ? "worse" : "";
    const percent = (ratio) => `${ratio >= 1 ? "+" : "−"}${Math.abs(100 * (ratio - 1)).toFixed(1)}`;
    const part = ` ${percent(median)} % (${percent(p25)} to ${percent(p75)})`;
    const cell = change(before, after, ms, how);
    cell.lastChild.textContent = { better: "▲ faster", worse: "▼ slower", "": "within frame variation" }[how] + part;
    return cell;
  };
  const body = prices.map((p) => el("tr", { "data-row": p.switched },
    el("th", { scope: "row" }, pointLink(p.switched, p.switch), el("div", { class: "small" }, "against ", pointLink(p.base))),
    time(p),
    change(...p.bytes_per_pixel, (v) => fixed(v, 0), verdict(less(0), ...p.bytes_per_pixel)),
    change(...p.memory_bytes_per_pixel, (v) => fixed(v, 1), verdict(less(1), ...p.memory_bytes_per_pixel)),
    ...mainMetrics().map((m) => {
      const pair = p.values[m.key] ?? [null, null];
      const [a, b] = [p.base, p.switched].map((id) => rows.get(id).spread[m.key]);
      const varies = a && b && a[0] <= b[1] && b[0] <= a[1];
      return change(...pair, (v) => fixed(v, m.digits), varies ? "seeds" : verdict(m, ...pair));
    }),
  ));
  const names = ["Pass, ms", "Bytes moved per pixel", "Bytes kept per pixel", ...mainMetrics().map(headed)];
  const head = el("tr", {}, el("th", {}, "Switch"), ...names.map((n) => el("th", { class: "number" }, n)));
  byId("prices").replaceChildren(el("caption", { class: "small" }, "without the switch → with it"), el("thead", {}, head), el("tbody", {}, ...body));
}

function showConvergences() {
  const all = table.convergences.filter((c) => c.input === chosen.input);
  byId("converging").hidden = !all.length;
  const bands = ["whole", "< 2.5°", "2.5° to 7.5°", "> 7.5°"];
  const number = (text) => el("td", { class: "number" }, text);
  // The highest efficiency over all sample counts: beyond it, further samples are worth less than their time.
  const efficiencies = all.map((c) => bands.map((_, i) => Math.max(0, ...c.points.map((p) => p.efficiency[i] ?? 0))));
  const highest = bands.map((_, i) => Math.max(...efficiencies.map((e) => e[i])));
  const efficiency = (v, i) => number(v === 0 ? "—" : v === highest[i] ? el("b", {}, `★ ${threeDigits(v)}`) : threeDigits(v));
  const body = all.map((c, row) => {
    const samples = c.points.map((p) => fixed(p.samples_per_pixel, 1));
    return el("tr", {}, el("th", { scope: "row" }, c.label), number(`${samples[0]} to ${samples.at(-1)} (${samples.length} points)`),
      ...[c.slope_by_samples, c.slope_by_time].flatMap((slopes) => slopes.map((v) => number(fixed(v, 2)))), ...efficiencies[row].map(efficiency));
  });
  const titles = ["slope by samples", "slope by time", "highest efficiency"];
  const groups = el("tr", {}, el("td"), el("td"), ...titles.map((n) => el("th", { colspan: bands.length, class: "number" }, n)));
  const head = el("tr", {}, el("th", {}, "Points"), el("th", { class: "number" }, "Samples per pixel"),
    ...titles.flatMap(() => bands).map((n) => el("th", { class: "number" }, n)));
  byId("convergences").replaceChildren(el("thead", {}, groups, head), el("tbody", {}, ...body));
}

const sorting = { column: "Cost, ms", down: false };

function showPoints() {
  const number = (name, of, text) => ({ name, of, text: (row) => text(of(row)) });
  const columns = [
    { name: "★", of: (row) => (row.frontier.includes(chosen.metric.key) ? 0 : 1), text: (row) => row.frontier.includes(chosen.metric.key) ? "★" : "" },
    { name: "Point", of: (row) => row.label },
    number("Cost, ms", (row) => row.cost_ms, ms),
    { name: "Pass, ms (quartiles)", of: (row) => row.pass_ms.median, text: (row) => `${ms(row.pass_ms.median)} (${ms(row.pass_ms.p25)}–${ms(row.pass_ms.p75)})` },
    number("Renderer, ms", (row) => row.render_ms, ms),
    number("Copy, ms", (row) => row.copy_ms, ms),
    number("Samples", (row) => row.samples_share, percent),
    number("Bytes moved", (row) => row.bytes_per_pixel, (v) => fixed(v, 0)),
    number("Bytes kept", (row) => row.memory_bytes_per_pixel, (v) => fixed(v, 1)),
    ...mainMetrics().map((m) => number(headed(m), (row) => row.values[m.key], (v) => fixed(v, m.digits))),
    number("Drift", (row) => row.drift, (v) => fixed(v, 3)),
    number("Seeds", (row) => row.seeds, String),
    number("Not finite", (row) => row.nonfinite_out, String),
  ];
  const by = columns.find((c) => c.name === sorting.column) ?? columns[2];
  // Unknown values come last in both directions.
  const order = (a, b) => {
    const [x, y] = [by.of(a), by.of(b)];
    if (x == null || y == null) return (x == null) - (y == null);
    const less = typeof x === "string" ? x.localeCompare(y) : x - y;
    return sorting.down ? -less : less;
  };
  const head = columns.map((c) => {
    const sort = () => {
      sorting.down = sorting.column === c.name && !sorting.down;
      sorting.column = c.name;
      showPoints();
      [...document.querySelectorAll("#points thead button")].find((b) => b.dataset.name === c.name)?.focus();
    };
    const state = by === c ? (sorting.down ? "descending" : "ascending") : null;
    const arrow = state ? (sorting.down ? " ↓" : " ↑") : "";
    return el("th", { "aria-sort": state, class: c.text ? "number" : null }, el("button", { type: "button", "data-name": c.name, onclick: sort }, c.name + arrow));
  });
  const body = ofInput().sort(order).map((row) => el("tr", { "data-row": row.id, class: row.id === chosen.pinned ? "chosen" : null },
    ...columns.map((c) => c.text ? el("td", { class: c.name === "★" ? "star" : "number" }, c.text(row)) : el("th", { scope: "row" }, pointLink(row.id))),
    el("td", {}, copyButton(row.command, `command of ${row.label}`)),
  ));
  byId("points").replaceChildren(el("thead", {}, el("tr", {}, ...head, el("th", {}, "Command"))), el("tbody", {}, ...body));
}
