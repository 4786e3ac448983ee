// SPDX-License-Identifier: GPL-3.0-or-later
// Lists, toggles and tables beside the picture.

export function element(tag, attributes = {}, ...children) {
  const e = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) e.addEventListener(name.slice(2), value);
    else if (value === true) e.setAttribute(name, "");
    else if (value !== false && value !== undefined) e.setAttribute(name, value);
  }
  e.append(...children);
  return e;
}

export const grouped = (n) => n.toLocaleString("en-US");
export function length_text(mm) {
  const size = Math.abs(mm);
  if (size !== 0 && size < 0.1) return `${Number((mm * 1e3).toPrecision(4))} \u00b5m`;
  return `${Number(mm.toPrecision(5))} mm`;
}
export const short = (x, digits = 4) => (Number.isFinite(x) ? String(Number(x.toPrecision(digits))) : "\u2013");

/// A list of things that can be hidden. items: { name, colour, groups: [indices], note }.
export class ToggleList {
  constructor(host, items, { searchable, on_change, on_only, on_all, kind }) {
    this.items = items;
    this.boxes = [];
    this.on_change = on_change;
    if (searchable && items.length > 8) {
      host.append(element("input", {
        type: "search", placeholder: `Find a ${kind}`, "aria-label": `Find a ${kind}`, class: "search",
        oninput: (event) => {
          const text = event.target.value.toLowerCase();
          rows.forEach((row, i) => (row.hidden = !items[i].name.toLowerCase().includes(text)));
        },
      }));
    }
    const rows = items.map((item, i) => {
      const box = element("input", { type: "checkbox", checked: true, onchange: () => on_change(item, box.checked) });
      this.boxes[i] = box;
      this.swatches ??= [];
      const swatch = (this.swatches[i] = element("span", { class: "swatch", "aria-hidden": "true" }));
      swatch.style.background = item.colour;
      return element("li", {},
        element("label", { title: item.name }, box, swatch, element("span", { class: "name" }, item.name), element("span", { class: "count" }, item.note ?? "")),
        on_only ? element("button", { type: "button", class: "only", "aria-label": `Show ${item.name} alone`, onclick: () => on_only(item) }, "only") : "");
    });
    host.append(element("ul", { class: "toggles" }, ...rows));
    if (on_all) host.append(element("button", { type: "button", class: "link", onclick: on_all }, "Show all again"));
  }
  /// Boxes as the hidden groups say: checked if any group shows.
  update(hidden) {
    this.items.forEach((item, i) => {
      const shown = item.groups.filter((g) => !hidden[g]).length;
      this.boxes[i].checked = shown > 0;
      this.boxes[i].indeterminate = shown > 0 && shown < item.groups.length;
    });
  }
}

export function table(caption, head, rows) {
  return element("table", {},
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, ...head.map((h) => element("th", { scope: "col" }, h)))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((cell, i) => (i === 0 ? element("th", { scope: "row", title: cell }, cell) : element("td", {}, cell)))))));
}

export function definition_list(entries) {
  return element("dl", {}, ...entries.map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value))));
}
