// Two pictures with a divider, and their error maps.
const REFERENCE = "";

function showCompare() {
  const of = (row) => pictures.points[row.id];
  const shown = ofInput().filter((row) => of(row)?.shown != null);
  if (!shown.length) return byId("compare").replaceChildren(el("p", {}, "No pictures for this input."));
  const image = (index) => (index == null ? null : pictures.images[index]);
  const reference = image(of(shown[0]).reference);
  const select = (name, value) => {
    const list = el("select", { onchange: draw }, reference && el("option", { value: REFERENCE }, "reference: all pixels at full rate"),
      ...shown.map((row) => el("option", { value: row.id }, `${row.label} (${withUnit(chosen.metric, row.values[chosen.metric.key])})`)));
    list.value = value;
    return [el("label", {}, name, list), list];
  };
  const best = shown.find((row) => row.id === firstPinned()) ?? shown.at(-1);
  const plain = shown.find((row) => row.method === "none" && row.samples_share === best.samples_share) ?? shown[0];
  const [leftLabel, left] = select("Left ", plain.id);
  const [rightLabel, right] = select("Right ", best.id);
  const under = el("img"), over = el("img", { class: "over" });
  const split = el("div", { class: "split" }, under, over);
  const divider = el("input", { type: "range", min: 0, max: 100, value: 50, step: 0.5, class: "divider", "aria-label": "Divider between left and right",
    oninput: () => split.style.setProperty("--at", `${divider.value}%`) });
  const drag = (event) => {
    const box = split.getBoundingClientRect();
    divider.value = (100 * (event.clientX - box.left)) / box.width;
    divider.dispatchEvent(new Event("input"));
  };
  split.addEventListener("pointerdown", (event) => { event.preventDefault(); split.setPointerCapture(event.pointerId); drag(event); });
  split.addEventListener("pointermove", (event) => event.buttons && drag(event));
  const errors = el("div", { class: "pair" });
  function draw() {
    const picture = (id) => (id === REFERENCE ? reference : image(of(rows.get(id)).shown));
    const name = (id) => (id === REFERENCE ? "reference" : rows.get(id).label);
    for (const [img, list] of [[under, left], [over, right]]) {
      img.src = picture(list.value);
      img.alt = name(list.value);
    }
    errors.replaceChildren(...[left, right].map(({ value }) => {
      const error = value === REFERENCE ? null : image(of(rows.get(value)).error);
      const text = value === REFERENCE ? "the reference has no error" : `FLIP of ${name(value)}${error ? "" : ": no picture"}`;
      return el("figure", {}, el("figcaption", { class: "small" }, text), error && el("img", { src: error, alt: text }));
    }));
  }
  const count = ofInput().length;
  const note = shown.length < count ? `Pictures of ${shown.length} of the ${count} points are embedded in this page. ` : "";
  byId("compare").replaceChildren(
    el("p", { class: "faint" }, note, "The last frame of the clip. Drag the divider over the picture, or move it with the arrow keys. Below: FLIP per pixel, black 0, white 1."),
    el("div", { class: "choose" }, leftLabel, rightLabel), split, divider, errors);
  draw();
}
