// SPDX-License-Identifier: GPL-3.0-or-later
import { decode } from "./decode.mjs";
import { definition_list, element, grouped, length_text, short, table, ToggleList } from "./panel.mjs";
import { is_continuous, modes, Paint } from "./paint.mjs";
import { Prisms } from "./prisms.mjs";
import { has_webgl, Stage } from "./stage.mjs";

const $ = (id) => document.getElementById(id);
const tables = JSON.parse($("tables").textContent);
const say = (text) => ($("live").textContent = text);

class Page {
  constructor(prisms) {
    this.prisms = prisms;
    this.hidden = tables.groups.map((g) => g.air);
    this.mode = "material";
    this.explode = 0;
    this.section = { axis: -1, share: 0.5, keep_above: false };
    this.stage = new Stage($("canvas"), prisms, () => this.place_pins());
    const height = prisms.slab_z.at(-1) - prisms.slab_z[0];
    const shown_height = this.shown_height() || height;
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
  shown_height() {
    const { slab_z, num_slabs, layer_of_slab } = this.prisms;
    let sum = 0;
    for (let s = 0; s < num_slabs; ++s)
      if (tables.groups.some((g, i) => !this.hidden[i] && g.layer === layer_of_slab[s])) sum += slab_z[s + 1] - slab_z[s];
    return sum;
  }

  /// Everything that hangs on what is shown and in which colours.
  refresh() {
    this.paint = new Paint(this.prisms, this.mode);
    this.stage.show(this.hidden, this.paint, this.explode > 0);
    for (const list of [this.layers, this.materials, this.nets]) list.update(this.hidden);
    this.make_legend();
    const shown = tables.groups.reduce((sum, g, i) => sum + (this.hidden[i] ? 0 : g.prisms), 0);
    $("shown").textContent = `${grouped(shown)} of ${grouped(tables.num_prisms)} prisms shown`;
  }

  // ---- left: what is shown

  make_lists() {
    const groups_where = (test) => tables.groups.flatMap((g, i) => (test(g) ? [i] : []));
    const count = (groups) => grouped(groups.reduce((sum, i) => sum + tables.groups[i].prisms, 0));
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
    const layers = items_of(tables.layers, "layer").reverse();
    this.layers = new ToggleList($("layers"), layers, { ...options, kind: "layer", searchable: true });
    this.materials = new ToggleList($("materials"), items_of(tables.materials, "material"), { ...options, kind: "material" });
    const nets = items_of(tables.nets, "net");
    const none = groups_where((g) => g.net < 0);
    if (none.length > 0) nets.push({ name: "no net", colour: "#b0aaa0", groups: none, note: count(none) });
    this.nets = new ToggleList($("nets"), nets, { ...options, kind: "net", searchable: true });
    $("layers_count").textContent = layers.length;
    $("nets_count").textContent = nets.length;
    $("materials_count").textContent = this.materials.items.length;

    $("tags_count").textContent = tables.face_tags.length;
    // What lies inside shows at once; the hull only on request.
    const port_colour = "#e02482";
    this.tag_shown = tables.face_tags.map((t) => t.kind === "port" || t.kind === "wave_port" || t.kind === "sheet");
    this.tag_colours = tables.face_tags.map((t) => (t.kind.endsWith("port") ? port_colour : t.kind === "sheet" ? "#cd7f3c" : t.colour));
    const tag_list = new ToggleList($("tags"), tables.face_tags.map((t, i) => ({ name: t.name, colour: this.tag_colours[i], groups: [], index: i, note: grouped(t.triangles + t.quads) })), {
      kind: "tag", searchable: true,
      on_change: (item, shown) => {
        this.tag_shown[item.index] = shown;
        this.show_tags();
        say(`Face tag ${item.name} ${shown ? "shown" : "no longer shown"}`);
      },
    });
    tag_list.boxes.forEach((box, i) => (box.checked = this.tag_shown[i]));
    $("tags").append(table("Face tags: boundaries, conductor skins, ports", ["name", "id", "kind", "condition", "area, mm\u00b2"],
      tables.face_tags.map((t) => [t.name, String(t.id), t.kind, t.condition, short(t.area_m2 * 1e6)])));
    $("tags").append(element("button", { type: "button", class: "link", onclick: () => this.set_mode("tag") }, "Colour all faces by tag"));
    $("tags").append(table("Volume groups", ["name", "id", "prisms", "volume, mm\u00b3"], tables.groups.map((g) => [g.name, String(g.id), grouped(g.prisms), short(g.volume_m3 * 1e9)])));
  }

  show_tags() {
    const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
    this.stage.show_tags(this.tag_shown, this.tag_colours.map(rgb));
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
      host.append(bar, element("div", { class: "ramp_ends" }, element("span", {}, text[0]), element("span", {}, text[1])));
      return;
    }
    const entries = new Map();
    if (this.mode === "tag") {
      tables.face_tags.forEach((t) => entries.set(t.name, t.colour));
      entries.set("no tag", "#969ca3");
    } else {
      tables.groups.forEach((g, i) => {
        if (this.hidden[i]) return;
        if (this.mode === "material") entries.set(tables.materials[g.material].name, tables.materials[g.material].colour);
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
    const { box, slab_z } = this.prisms;
    $("section_row").hidden = axis < 0;
    if (axis < 0) {
      $("section_value").textContent = "";
      return this.stage.set_section(null);
    }
    const ends = [[box.min_x, box.max_x], [box.min_y, box.max_y], [slab_z[0], slab_z.at(-1)]][axis];
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
      if (hit) this.stage.fly_to(hit.at, hit.slab, Math.max(this.prisms.longest[hit.t] * 25, 0.02));
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

  describe(hit) {
    const p = this.prisms;
    let sublayer = p.first_sublayer[hit.slab];
    while (sublayer + 1 < p.first_sublayer[hit.slab + 1] && hit.at[2] > p.z[sublayer + 1]) ++sublayer;
    const height = p.z[sublayer + 1] - p.z[sublayer];
    const group = tables.groups[p.group(hit.slab, hit.t)], material = tables.materials[group.material];
    const tag = hit.kind === "section" ? -1 : p.face_tag(hit.kind, hit.slab, hit.t, hit.a, hit.b);
    return {
      ...hit, sublayer, prism: p.cell_number(hit.slab, sublayer, hit.t), group: group.name, group_id: group.id,
      layer: tables.layers[group.layer].name, material: material.name, net: group.net < 0 ? "none" : tables.nets[group.net].name,
      face_tag: tag < 0 ? "none" : tables.face_tags[tag].name, face_tag_id: tag < 0 ? null : tables.face_tags[tag].id,
      q_p: p.prism_quality(hit.slab, hit.t, height), q_t: p.triangle_quality(hit.t), longest_mm: p.longest[hit.t], height_mm: height, eps_r: material.eps_r,
    };
  }
  show_pick(hit) {
    const card = $("pick");
    if (!hit) {
      card.hidden = true;
      this.picked = null;
      this.stage.mark(null);
      return;
    }
    const d = (this.picked = this.describe(hit));
    this.stage.mark(d);
    const face = { up: "top face", down: "bottom face", wall: "side face", section: "cut" }[d.kind];
    card.replaceChildren(
      element("h2", {}, `Prism ${grouped(d.prism)}${this.hidden[this.prisms.group(d.slab, d.t)] ? " (hidden)" : ""}`, element("button", { type: "button", class: "close", "aria-label": "Close", onclick: () => this.show_pick(null) }, "\u00d7")),
      definition_list([
        ["Layer", d.layer], ["Material", `${d.material} (\u03b5r ${short(d.eps_r)})`], ["Net", d.net],
        ["Volume group", `${d.group_id}: ${d.group}`], [`Face tag, ${face}`, d.face_tag_id === null ? "none" : `${d.face_tag_id}: ${d.face_tag}`],
        ["Triangle, sub-layer", `${grouped(d.t)}, ${d.sublayer}`], ["q_p, q_t", `${short(d.q_p)}, ${short(d.q_t)}`],
        ["Longest edge, height", `${length_text(d.longest_mm)}, ${length_text(d.height_mm)}`],
        ["Place", d.at.map((v) => Number(v.toFixed(4))).join(", ") + " mm"],
      ]));
    card.hidden = false;
    say(`Prism ${d.prism}, layer ${d.layer}, material ${d.material}, net ${d.net}, quality ${short(d.q_p)}`);
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
  fly_to(place, at_m) {
    const at = at_m.map((v) => v * 1e3);
    const p = this.prisms;
    let slab = 0;
    while (slab + 1 < p.num_slabs && at[2] > p.slab_z[slab + 1]) ++slab;
    const t = p.locate(at[0], at[1]);
    this.pin = { at, slab, text: place.code };
    this.stage.fly_to(at, slab, t >= 0 ? Math.min(this.stage.side, Math.max(p.longest[t] * 40, this.stage.side / 200)) : this.stage.side / 10);
    if (t >= 0 && p.group(slab, t) >= 0) this.show_pick({ slab, t, kind: "up", a: -1, b: -1, at });
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
    const { layers, materials, nets } = tables.quality;
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
  const page = new Page(new Prisms(tables, arrays));
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
