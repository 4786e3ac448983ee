// SPDX-License-Identifier: GPL-3.0-or-later
import { Cells } from "./cells.mjs";
import { decode } from "./decode.mjs";
import { definition_list, element, grouped, length_text, short, table, ToggleList } from "./panel.mjs";
import { is_continuous } from "./paint.mjs";
import { Prisms } from "./prisms.mjs";
import { has_webgl, Stage } from "./stage.mjs";

const $ = (id) => document.getElementById(id);
const tables = JSON.parse($("tables").textContent);
const { modes } = tables;
const port_colour = "#e02482";
const say = (text) => ($("live").textContent = text);

class Page {
  /// @param model  Prisms or Cells
  constructor(model) {
    this.model = model;
    this.hidden = tables.groups.map((g) => g.air);
    this.mode = modes[0][0];
    this.explode = 0;
    this.section = { axis: -1, share: 0.5, keep_above: false };
    this.stage = new Stage($("canvas"), model, () => this.place_pins());
    const shown_height = model.shown_height(this.hidden) || model.z_range[1] - model.z_range[0];
    this.thickness = Math.max(1, Math.round((this.stage.side / 20 / shown_height) * 2) / 2);
    this.make_lists();
    this.make_controls();
    this.make_findings();
    this.make_quality();
    this.stage.set_thickness(this.thickness);
    this.refresh();
    this.show_tags();
    this.stage.look_from(-35, 38);
    this.set_theme(document.documentElement.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"), false);
  }
  /// Everything that hangs on what is shown and in which colours.
  refresh() {
    this.paint = this.model.paint(this.mode);
    this.stage.show(this.hidden, this.paint, this.explode > 0);
    for (const list of this.lists) list.update(this.hidden);
    this.make_legend();
    const shown = tables.groups.reduce((sum, g, i) => sum + (this.hidden[i] ? 0 : g.cells), 0);
    $("shown").textContent = `${grouped(shown)} of ${grouped(tables.num_cells)} ${this.model.word} shown`;
  }

  // ---- left: what is shown

  make_lists() {
    const groups_where = (test) => tables.groups.flatMap((g, i) => (test(g) ? [i] : []));
    const count = (groups) => grouped(groups.reduce((sum, i) => sum + tables.groups[i].cells, 0));
    // Air that fills the gaps of a copper layer is air's business, not that layer's.
    const solid = (groups) => (groups.every((i) => tables.groups[i].air) ? groups : groups.filter((i) => !tables.groups[i].air));
    const items_of = (names, field) =>
      names.map((n, i) => ({ name: n.name, colour: n.colour, groups: solid(groups_where((g) => g[field] === i)) })).filter((item) => item.groups.length > 0)
        .map((item) => ({ ...item, note: count(item.groups) }));
    const on_change = (item, shown) => {
      for (const g of item.groups) this.hidden[g] = !shown;
      this.refresh();
      say(`${item.name} ${shown ? "shown" : "hidden"}`);
    };
    const on_only = (item) => {
      this.hidden.fill(true);
      for (const g of item.groups) this.hidden[g] = false;
      this.refresh();
      say(`Only ${item.name} shown`);
    };
    const on_all = () => {
      tables.groups.forEach((g, i) => (this.hidden[i] = g.air));
      this.refresh();
      say("Everything but air shown");
    };
    const options = { on_change, on_only, on_all };
    this.lists = [];
    // A list without entries has no place in the panel.
    const list = (id, items, more) => {
      $(id).closest("details").hidden = items.length === 0;
      $(`${id}_count`).textContent = items.length;
      if (items.length > 0) this.lists.push(new ToggleList($(id), items, { ...options, ...more }));
    };
    list("layers", items_of(tables.layers, "layer").reverse(), { kind: "layer", searchable: true });
    list("materials", items_of(tables.materials, "material"), { kind: "material" });
    const nets = items_of(tables.nets, "net");
    const none = groups_where((g) => g.net < 0);
    if (none.length > 0 && tables.nets.length > 0) nets.push({ name: "no net", colour: "#b0aaa0", groups: none, note: count(none) });
    list("nets", nets, { kind: "net", searchable: true });
    // Groups that tell neither layer nor material are shown and hidden by their own names.
    const nameless = groups_where((g) => g.layer === undefined || g.layer < 0);
    list("groups", nameless.map((i) => ({ name: tables.groups[i].name, colour: tables.groups[i].colour, groups: [i], note: count([i]) })), { kind: "volume group", searchable: true });
    this.make_tags();
    this.make_ports();
    const volumes = ["name", "id", this.model.word, "volume, mm\u00b3"].concat(this.model.exact_section ? [] : ["mean quality", "worst"]);
    $("tags").append(table("Volume groups", volumes, tables.groups.map((g) => [g.name, String(g.id), grouped(g.cells), short(g.volume_m3 * 1e9)]
      .concat(this.model.exact_section ? [] : g.mean_quality > 0 ? [short(g.mean_quality), short(g.worst_quality, 3)] : ["\u2013", "\u2013"]))));
  }

  make_tags() {
    $("tags_count").textContent = tables.face_tags.length;
    // What lies inside shows at once; the hull only on request.
    const is_port = (t) => t.kind === "port" || t.kind === "wave_port";
    this.tag_shown = tables.face_tags.map((t) => is_port(t) || t.kind === "sheet");
    this.tag_colours = tables.face_tags.map((t) => (is_port(t) ? port_colour : t.kind === "sheet" ? "#cd7f3c" : t.colour));
    const faces_of = (t) => t.faces ?? t.triangles + t.quads;
    this.tag_list = new ToggleList($("tags"), tables.face_tags.map((t, i) => ({ name: t.name, colour: this.tag_colours[i], groups: [], index: i, note: grouped(faces_of(t)) })), {
      kind: "tag", searchable: true,
      on_change: (item, shown) => {
        this.tag_shown[item.index] = shown;
        this.show_tags();
        say(`Face tag ${item.name} ${shown ? "shown" : "no longer shown"}`);
      },
    });
    const columns = this.model.exact_section
      ? [["name", "id", "kind", "condition", "area, mm\u00b2"], (t) => [t.name, String(t.id), t.kind, t.condition, short(t.area_m2 * 1e6)]]
      : [["name", "id", "kind", "faces"], (t) => [t.name, String(t.id), t.kind || "\u2013", grouped(t.faces)]];
    if (tables.face_tags.length === 0) return;
    $("tags").append(table("Face tags: boundaries, conductor skins, ports", columns[0], tables.face_tags.map(columns[1])));
    $("tags").append(element("button", { type: "button", class: "link", onclick: () => this.set_mode("tag") }, "Colour all faces by tag"));
  }

  /// Ports: what they are, shown or not, and a button that flies there.
  make_ports() {
    // Of a file of cells the names of port faces are all there is.
    this.ports = tables.ports ?? tables.face_tags.flatMap((t, i) => {
      const at = t.kind.endsWith("port") ? this.model.middle_of_tag(i) : null;
      return at ? [{ name: t.name.replace(/^(wave_)?port\|/, ""), kind: t.kind === "port" ? "lumped" : "wave", tags: [i], at_m: at.map((v) => v / 1e3) }] : [];
    });
    $("ports").closest("details").hidden = this.ports.length === 0;
    $("ports_count").textContent = this.ports.length;
    const list = element("ul", { class: "places" });
    for (const port of this.ports) {
      port.box = element("input", { type: "checkbox", onchange: () => {
        for (const tag of port.tags) this.tag_shown[tag] = port.box.checked;
        this.show_tags();
        say(`Port ${port.name} ${port.box.checked ? "shown" : "hidden"}`);
      } });
      const swatch = element("span", { class: "swatch", "aria-hidden": "true" });
      swatch.style.background = port_colour;
      const facts = [`${port.kind} port`];
      if (port.impedance_ohm !== undefined) facts.push(`${short(port.impedance_ohm)} \u03a9`, port.excited ? "excited" : "passive");
      if (port.direction) facts.push(`field along ${port.direction}`);
      const nets = port.positive_net || port.negative_net ? [`from ${port.negative_net ?? "no net"} (\u2212) to ${port.positive_net ?? "no net"} (+)`] : [];
      if (port.length_m) nets.push(`${length_text(port.length_m * 1e3)} long, ${length_text(port.width_m * 1e3)} wide`);
      list.append(element("li", {},
        element("label", {}, port.box, swatch, element("strong", {}, port.name)),
        element("p", {}, facts.join(", ")), nets.length > 0 ? element("p", {}, nets.join("; ")) : "",
        element("div", { class: "fly" }, element("button", { type: "button", "aria-label": `Show port ${port.name}`, onclick: () => this.fly_to({ code: `port ${port.name}`, span: port.length_m && 12e3 * Math.max(port.length_m, port.width_m) }, port.at_m) },
          `at ${short(port.at_m[0] * 1e3)}, ${short(port.at_m[1] * 1e3)} mm`))));
    }
    $("ports").append(list);
  }

  show_tags() {
    const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
    this.stage.show_tags(this.tag_shown, this.tag_colours.map(rgb));
    this.tag_list.boxes.forEach((box, i) => (box.checked = this.tag_shown[i]));
    for (const port of this.ports) {
      const shown = port.tags.filter((tag) => this.tag_shown[tag]).length;
      port.box.checked = shown > 0;
      port.box.indeterminate = shown > 0 && shown < port.tags.length;
    }
    this.make_legend();
  }

  make_legend() {
    const host = $("legend");
    host.replaceChildren(element("h2", {}, modes.find(([name]) => name === this.mode)[1]));
    if (is_continuous(this.mode)) {
      const [low, high] = this.paint.range;
      const bar = element("div", { class: "ramp", "aria-hidden": "true" });
      bar.style.background = `linear-gradient(90deg, ${tables.ramp.join(", ")})`;
      const text = this.mode === "size" ? [length_text(low), length_text(high)] : [short(low), short(high)];
      // A cut through a file of cells is no cell, so it has no quality.
      if (!this.model.exact_section && this.section.axis >= 0) host.append(element("p", {}, "grey: the cut, which has no value"));
      host.append(bar, element("div", { class: "ramp_ends" }, element("span", {}, text[0]), element("span", {}, text[1])));
      return;
    }
    const entries = new Map();
    if (this.mode === "tag") {
      tables.face_tags.forEach((t) => entries.set(t.name, t.colour));
      entries.set("no tag", "#969ca3");
    } else {
      tables.groups.forEach((g, i) => {
        if (this.hidden[i] || g.cells === 0) return;
        if (g.material < 0) entries.set(g.name, g.colour);
        else if (this.mode === "material") entries.set(tables.materials[g.material].name, tables.materials[g.material].colour);
        else if (this.mode === "layer") entries.set(tables.layers[g.layer].name, tables.layers[g.layer].colour);
        else if (this.mode === "net") entries.set(g.net < 0 ? "no net" : tables.nets[g.net].name, g.net < 0 ? "#c9c5bb" : tables.nets[g.net].colour);
        else entries.set(g.name, g.colour);
      });
    }
    if (this.mode !== "tag") tables.face_tags.forEach((t, i) => this.tag_shown[i] && entries.set(`tag ${t.name}`, this.tag_colours[i]));
    const most = 9;
    const list = element("ul", {});
    for (const [name, colour] of [...entries].slice(0, most)) {
      const swatch = element("span", { class: "swatch" });
      swatch.style.background = colour;
      list.append(element("li", {}, swatch, element("span", { class: "name" }, name)));
    }
    host.append(list);
    if (entries.size > most) host.append(element("p", {}, `and ${entries.size - most} more`));
  }

  // ---- controls

  make_controls() {
    const colour = $("colour");
    for (const [name, title] of modes) colour.append(element("option", { value: name }, title));
    colour.addEventListener("change", () => this.set_mode(colour.value));
    $("edges").addEventListener("change", () => this.set_edges($("edges").checked));
    $("explode").addEventListener("input", () => this.set_explode(Number($("explode").value)));
    $("thickness").value = Math.log2(this.thickness);
    $("thickness_value").textContent = `\u00d7 ${short(this.thickness, 3)}`;
    $("thickness").addEventListener("input", () => {
      this.thickness = 2 ** Number($("thickness").value);
      $("thickness_value").textContent = `\u00d7 ${short(this.thickness, 3)}`;
      this.stage.set_thickness(this.thickness);
    });
    $("section_axis").addEventListener("change", () => this.choose_section(["x", "y", "z"].indexOf($("section_axis").value)));
    $("section_at").addEventListener("input", () => this.set_section({ share: Number($("section_at").value) }));
    $("section_side").addEventListener("change", () => this.set_section({ keep_above: $("section_side").checked }));
    const views = { iso: [-35, 38], top: [0, 90], bottom: [0, -90], front: [0, 8], right: [90, 8] };
    for (const [name, angles] of Object.entries(views)) $(`view_${name}`).addEventListener("click", () => this.stage.look_from(...angles));
    $("view_fit").addEventListener("click", () => this.stage.fit());
    $("theme").addEventListener("click", () => this.set_theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark", true));
    $("print").addEventListener("click", () => window.print());
    $("panel_toggle").addEventListener("click", () => {
      const closed = document.body.classList.toggle("panel_closed");
      $("panel_toggle").setAttribute("aria-expanded", String(!closed));
    });
    $("help_open").addEventListener("click", () => $("help").showModal());
    $("help_close").addEventListener("click", () => $("help").close());
    this.make_pointer();
    this.make_keyboard();
    window.addEventListener("beforeprint", () => this.before_print());
    window.addEventListener("afterprint", () => this.after_print());
  }
  set_mode(mode) {
    this.mode = mode;
    $("colour").value = mode;
    this.refresh();
    say(`Coloured by ${modes.find(([name]) => name === mode)[1]}`);
  }
  set_edges(on) {
    $("edges").checked = on;
    this.stage.set_edges(on);
  }
  set_explode(amount) {
    const changes = amount > 0 !== this.explode > 0;
    this.explode = amount;
    $("explode").value = amount;
    $("explode_value").textContent = amount === 0 ? "off" : short(amount, 2);
    if (changes) this.refresh();
    this.stage.set_explode(amount);
  }
  /// A new plane cuts away what stands before it.
  choose_section(axis) {
    if (axis >= 0) $("section_side").checked = this.stage.looks_from_below(axis);
    this.set_section({ axis, keep_above: $("section_side").checked });
  }
  set_section(change) {
    Object.assign(this.section, change);
    const { axis, share, keep_above } = this.section;
    const { box, z_range } = this.model;
    $("section_row").hidden = axis < 0;
    this.make_legend();
    if (axis < 0) {
      $("section_value").textContent = "";
      return this.stage.set_section(null);
    }
    const ends = [[box.min_x, box.max_x], [box.min_y, box.max_y], z_range][axis];
    const at = ends[0] + share * (ends[1] - ends[0]);
    $("section_value").textContent = length_text(at);
    this.stage.set_section({ axis, at, keep_above });
  }
  set_theme(theme, chosen) {
    if (chosen || document.documentElement.dataset.theme) document.documentElement.dataset.theme = theme;
    else document.documentElement.dataset.theme = theme;
    $("theme").setAttribute("aria-pressed", String(theme === "dark"));
    this.stage.set_edge_colour(...(theme === "dark" ? [0.03, 0.04, 0.05] : [0.07, 0.09, 0.11]));
  }

  make_pointer() {
    const canvas = $("canvas");
    let down = null;
    canvas.addEventListener("pointerdown", (e) => (down = { x: e.clientX, y: e.clientY }));
    canvas.addEventListener("pointerup", (e) => {
      if (!down || Math.hypot(e.clientX - down.x, e.clientY - down.y) > 4 || e.button !== 0) return;
      const box = canvas.getBoundingClientRect();
      this.show_pick(this.stage.pick(e.clientX - box.left, e.clientY - box.top));
    });
    canvas.addEventListener("dblclick", (e) => {
      const box = canvas.getBoundingClientRect();
      const hit = this.stage.pick(e.clientX - box.left, e.clientY - box.top);
      if (hit) this.stage.fly_to(hit.at, hit.slab, Math.max(this.model.size_of(hit) * 25, 0.02));
    });
  }

  make_keyboard() {
    const turn = Math.PI / 36;
    const keys = {
      ArrowLeft: (s) => (s ? this.stage.pan(-0.1, 0) : this.stage.rotate(-turn, 0)),
      ArrowRight: (s) => (s ? this.stage.pan(0.1, 0) : this.stage.rotate(turn, 0)),
      ArrowUp: (s) => (s ? this.stage.pan(0, 0.1) : this.stage.rotate(0, turn)),
      ArrowDown: (s) => (s ? this.stage.pan(0, -0.1) : this.stage.rotate(0, -turn)),
      "+": () => this.stage.zoom(1.25),
      "=": () => this.stage.zoom(1.25),
      "-": () => this.stage.zoom(0.8),
      Enter: () => this.show_pick(this.stage.pick($("canvas").clientWidth / 2, $("canvas").clientHeight / 2)),
      f: () => this.stage.fit(),
      "0": () => this.stage.look_from(-35, 38),
      t: () => this.stage.look_from(0, 90),
      b: () => this.stage.look_from(0, -90),
      e: () => this.set_edges(!this.stage.edges),
      x: () => this.set_explode(this.explode > 0 ? 0 : 1),
      c: () => this.set_mode(modes[(modes.findIndex(([name]) => name === this.mode) + 1) % modes.length][0]),
      Escape: () => this.show_pick(null),
      "?": () => $("help").showModal(),
    };
    $("canvas").addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const act = keys[event.key] ?? keys[event.key.toLowerCase()];
      if (!act) return;
      event.preventDefault();
      act(event.shiftKey);
    });
  }

  // ---- one cell

  show_pick(hit) {
    const card = $("pick");
    if (!hit) {
      card.hidden = true;
      this.picked = null;
      this.stage.mark(null);
      return;
    }
    const d = (this.picked = this.model.describe(hit)), told = this.model.card(d);
    this.stage.mark(d);
    card.replaceChildren(
      element("h2", {}, `${told.title}${this.hidden[this.model.group_of(d)] ? " (hidden)" : ""}`, element("button", { type: "button", class: "close", "aria-label": "Close", onclick: () => this.show_pick(null) }, "\u00d7")),
      definition_list([...told.rows, ["Place", d.at.map((v) => Number(v.toFixed(4))).join(", ") + " mm"]]));
    card.hidden = false;
    say(told.spoken);
  }

  // ---- findings

  make_findings() {
    const host = $("findings");
    $("findings_count").textContent = tables.places.filter((p) => p.severity === "error" || p.severity === "warning").length;
    if (!tables.places.length) host.append(element("p", {}, "Nothing to report."));
    const list = element("ul", { class: "places" });
    for (const place of tables.places) {
      const head = element("span", { class: `kind ${place.severity}` }, place.severity === "quality" ? "q" : place.severity);
      const item = element("li", {}, head, element("strong", {}, place.code), place.count > 1 ? ` \u00d7 ${grouped(place.count)}` : "", element("p", {}, place.text));
      if (place.at_m.length > 0)
        item.append(element("div", { class: "fly" }, ...place.at_m.map((at, i) =>
          element("button", { type: "button", onclick: () => this.fly_to(place, at), "aria-label": `Show place ${i + 1} of ${place.code}` },
            place.at_m.length === 1 ? `at ${short(at[0] * 1e3)}, ${short(at[1] * 1e3)} mm` : `place ${i + 1}`))));
      list.append(item);
    }
    host.append(list);
  }
  /// place.span: how many mm should fill the view; else what suits the cells there.
  fly_to(place, at_m) {
    const at = at_m.map((v) => v * 1e3);
    const storey = this.model.storey_at(at[2]), { size, hit } = this.model.look_up(at);
    this.pin = { at, slab: storey, text: place.code };
    const { side } = this.stage;
    this.stage.fly_to(at, storey, place.span ? place.span : size === null ? side / 10 : Math.min(side, Math.max(size * 40, side / 200)));
    if (hit) this.show_pick(hit);
    say(`${place.code} at ${short(at[0])}, ${short(at[1])} mm`);
  }
  place_pins() {
    const pin = $("pin");
    const at = this.pin && this.stage.project(this.pin.at, this.pin.slab);
    pin.hidden = !at;
    if (!at) return;
    pin.style.left = `${at[0]}px`;
    pin.style.top = `${at[1]}px`;
    pin.textContent = this.pin.text;
  }

  // ---- quality

  make_quality() {
    const head = ["", "prisms", "volume, mm\u00b3", "mean q_p", "by volume", "worst", "min angle", "max aspect"];
    const rows = (groups) => groups.map(([name, prisms, volume, mean, weighted, worst, angle, aspect]) =>
      [name, grouped(prisms), short(volume * 1e9), mean.toFixed(3), weighted.toFixed(3), short(worst, 3), `${angle.toFixed(1)}\u00b0`, short(aspect, 3)]);
    const { layers, materials, nets } = tables.quality ?? { layers: [], materials: [], nets: [] };
    const host = $("quality_tables");
    for (const [caption, groups] of [["Quality by layer", layers], ["Quality by material", materials], ["Quality by net", nets]])
      if (groups.length > 0) host.append(table(caption, head, rows(groups)));
  }

  // ---- printing

  before_print() {
    $("snapshot").src = $("canvas").toDataURL("image/png");
    this.opened = [...document.querySelectorAll("details:not([open])")];
    for (const d of this.opened) d.open = true;
  }
  after_print() {
    for (const d of this.opened ?? []) d.open = false;
  }
}

async function start() {
  if (!has_webgl()) throw new Error("This browser has no WebGL 2, so the 3D view stays empty. Tables and plots are here all the same.");
  const arrays = await decode($("mesh").textContent, tables.arrays);
  $("mesh").remove();
  const page = new Page(tables.kind === "cells" ? new Cells(tables, arrays) : new Prisms(tables, arrays));
  $("loading").hidden = true;
  return page;
}

/// For tests and scripts: the page, and a promise that is kept when the picture is whole.
window.pcbmesh = {
  page: null,
  settled: async () => {
    for (;;) {
      if (window.pcbmesh.failure) throw new Error(window.pcbmesh.failure);
      if (window.pcbmesh.page?.stage.settled) return true;
      await new Promise((resume) => setTimeout(resume, 20));
    }
  },
};
start().then(
  (page) => (window.pcbmesh.page = page),
  (error) => {
    window.pcbmesh.failure = String(error);
    $("loading").textContent = error.message;
    $("loading").classList.add("failed");
    throw error;
  },
);
