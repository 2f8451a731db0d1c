// Shared by the other parts: data, selection, and a constructor of elements whose text is never parsed as HTML.
const data = (id) => JSON.parse(document.getElementById(`data-${id}`).textContent);
const table = data("table"), metrics = data("metrics"), equal = data("equal"), plots = data("plots"), pictures = data("pictures");
const rows = new Map(table.rows.map((row) => [row.id, row]));
const inputs = [...new Set(table.rows.map((row) => row.input))];
const chosen = { input: inputs[0], metric: metrics[0], pinned: null };

// Metrics that tables always show.
const MAIN = ["jod", "flip", "psnr_db", "retained_psnr_db", "flicker", "ghost_energy"];
const mainMetrics = () => metrics.filter((m) => MAIN.includes(m.key) || m === chosen.metric);
const ofInput = () => table.rows.filter((row) => row.input === chosen.input);

const byId = (id) => document.getElementById(id);
const el = (name, attributes = {}, ...content) => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value != null) element.setAttribute(key, value);
  }
  element.append(...content.filter((c) => c != null));
  return element;
};

const fixed = (value, digits) => (value == null ? "—" : value.toFixed(digits));
const ms = (value) => fixed(value, 3);
const threeDigits = (value) => (value >= 100 ? value.toFixed(0) : value.toPrecision(3));
const percent = (value) => (value == null ? "—" : `${(100 * value).toFixed(1)} %`);
const withUnit = (metric, value) => fixed(value, metric.digits) + (metric.unit && value != null ? ` ${metric.unit}` : "");
const headed = (metric) => metric.title + (metric.unit ? `, ${metric.unit}` : "");
const direction = (metric) => (metric.more_is_better ? "higher is better" : "lower is better");

// Compares the printed values, so that invisible digits do not change the verdict.
const verdict = (metric, before, after) => {
  if (before == null || after == null) return "";
  const [a, b] = [before, after].map((v) => Number(v.toFixed(metric.digits)));
  return a === b ? "same" : b > a === metric.more_is_better ? "better" : "worse";
};

const copyButton = (text, name) => {
  const button = el("button", { type: "button", title: text, "aria-label": `Copy the ${name}` }, "Copy");
  button.addEventListener("click", async () => {
    let done = true;
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      // Browsers may deny the clipboard to a page opened from disk. Copying a selection works.
      const area = el("textarea", { readonly: true });
      area.value = text;
      button.after(area);
      area.select();
      done = document.execCommand("copy");
      area.remove();
    }
    button.textContent = done ? "Copied" : "Denied";
    setTimeout(() => (button.textContent = "Copy"), 1500);
  });
  return button;
};
