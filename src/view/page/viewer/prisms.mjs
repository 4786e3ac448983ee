// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh as the program knows it: planar triangles times slabs. Lengths in millimetres.
import { Cards } from "./cards.mjs";
import { unzigzag } from "./decode.mjs";
import { Paint } from "./paint.mjs";
import { grouped, length_text, short } from "./panel.mjs";
import { build, build_rim, build_section, build_tagged, Visibility } from "./skin.mjs";

/// Ye and Daniels, equation 2; beta: sum of the triangle's squared sides.
export function prism_quality(area, beta, height) {
  const sum = beta + height * height;
  return ((32 * Math.sqrt(3)) / 3) * ((area * height) / (sum * Math.sqrt(sum)));
}

/// What the page asks of a mesh; Cells answers the same. A storey is what the explosion moves as one: here a slab.
export class Prisms {
  constructor(tables, arrays) {
    this.tables = tables;
    this.word = "prisms";
    this.exact_section = true;
    this.num_points = arrays.x.length;
    this.num_triangles = arrays.corner0.length;
    const [x0, y0, step] = tables.grid;
    this.x = new Float64Array(this.num_points);
    this.y = new Float64Array(this.num_points);
    for (let i = 0; i < this.num_points; ++i) {
      this.x[i] = 1e3 * (x0 + step * arrays.x[i]);
      this.y[i] = 1e3 * (y0 + step * arrays.y[i]);
    }
    const corners = (this.corners = new Int32Array(3 * this.num_triangles));
    for (let t = 0; t < this.num_triangles; ++t) {
      const a = (corners[3 * t] = arrays.corner0[t]);
      corners[3 * t + 1] = a + unzigzag(arrays.corner1[t]);
      corners[3 * t + 2] = a + unzigzag(arrays.corner2[t]);
    }
    this.column = arrays.column;
    this.num_slabs = tables.columns[0].length;
    this.groups = new Int32Array(tables.columns.length * this.num_slabs);
    tables.columns.forEach((column, c) => this.groups.set(column, c * this.num_slabs));
    // Slabs: z of bottom and top, first sub-layer, layer.
    this.first_sublayer = new Int32Array(this.num_slabs + 1);
    tables.slab_of_sublayer.forEach((slab, k) => (this.first_sublayer[slab + 1] = k + 1));
    this.z = tables.z_m.map((z) => z * 1e3);
    this.slab_z = Array.from(this.first_sublayer, (k) => this.z[k]);
    this.layer_of_slab = Array.from({ length: this.num_slabs }, (_, s) => {
      for (const column of tables.columns) if (column[s] >= 0) return tables.groups[column[s]].layer;
      return -1;
    });
    this.caps = { tag: arrays.cap_tag, place: arrays.cap_place, triangle: arrays.cap_triangle };
    this.walls = { tag: arrays.wall_tag, slab: arrays.wall_slab, a: arrays.wall_a, b: arrays.wall_b.map((d, i) => arrays.wall_a[i] + unzigzag(d)) };
    this.find_neighbours();
    this.measure();
    this.z_range = [this.slab_z[0], this.slab_z.at(-1)];
    this.num_storeys = this.num_slabs;
  }

  // ---- drawing

  visibility(hidden, is_exploded) {
    return new Visibility(this, hidden, is_exploded);
  }
  paint(mode) {
    return new Paint(this, mode);
  }
  build(visibility, paint, centre) {
    return build(this, visibility, paint, centre);
  }
  build_rim(visibility, paint, centre) {
    return build_rim(this, visibility, paint, centre);
  }
  build_section(visibility, paint, centre, plane) {
    return build_section(this, visibility, paint, centre, plane);
  }
  build_tagged(visibility, wanted, colours, centre) {
    return build_tagged(this, visibility, wanted, colours, centre);
  }
  /// Pictures of layers, for while the view moves.
  cards() {
    return new Cards(this);
  }
  /// A rough count of triangles before they are made.
  guess_triangles(visibility, is_exploded) {
    return this.num_triangles * (is_exploded ? 2 * visibility.num_ranks : 2);
  }
  /// Storeys that show, as { storey, low, high }, and the box in the plane around all that shows.
  extent(visibility) {
    const { tables, num_slabs, slab_z, corners, column, x, y } = this;
    const storeys = [];
    const seen = new Uint8Array(tables.columns.length);
    for (let s = 0; s < num_slabs; ++s) {
      let used = false;
      for (let c = 0; c < seen.length; ++c) if (visibility.classes[c * num_slabs + s] >= 0) used = seen[c] = 1;
      if (used) storeys.push({ storey: s, low: slab_z[s], high: slab_z[s + 1] });
    }
    let [min_x, min_y, max_x, max_y] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let t = 0; t < this.num_triangles; ++t) {
      if (!seen[column[t]]) continue;
      for (let i = 0; i < 3; ++i) {
        const v = corners[3 * t + i];
        min_x = Math.min(min_x, x[v]);
        max_x = Math.max(max_x, x[v]);
        min_y = Math.min(min_y, y[v]);
        max_y = Math.max(max_y, y[v]);
      }
    }
    return { storeys, ...(min_x > max_x ? this.box : { min_x, min_y, max_x, max_y }) };
  }
  /// Height of what is not hidden.
  shown_height(hidden) {
    let sum = 0;
    for (let s = 0; s < this.num_slabs; ++s)
      if (this.tables.groups.some((g, i) => !hidden[i] && g.layer === this.layer_of_slab[s])) sum += this.slab_z[s + 1] - this.slab_z[s];
    return sum;
  }

  // ---- places

  storey_at(z) {
    let slab = 0;
    while (slab + 1 < this.num_slabs && z > this.slab_z[slab + 1]) ++slab;
    return slab;
  }
  /// The cell at a place as something picked, or null; and how large cells are there, mm.
  look_up(at) {
    const slab = this.storey_at(at[2]), t = this.locate(at[0], at[1]);
    return { size: t < 0 ? null : this.longest[t], hit: t >= 0 && this.group(slab, t) >= 0 ? { slab, t, kind: "up", a: -1, b: -1, at } : null };
  }
  size_of(hit) {
    return this.longest[hit.t];
  }
  group_of(hit) {
    return this.group(hit.slab, hit.t);
  }
  /// First shown cell under a ray of the stage: { s, slab, t, kind, a, b, at } or null.
  pick(stage, from, ray) {
    const { visibility, plane } = stage, thickness = stage.uniforms.thickness.value;
    const origin = [from.x + stage.centre[0], from.y + stage.centre[1]];
    let best = null;
    for (let slab = 0; slab < this.num_slabs; ++slab) {
      const low = stage.lift(this.slab_z[slab], slab), high = stage.lift(this.slab_z[slab + 1], slab);
      let s0 = 0, s1 = Infinity;
      if (Math.abs(ray.z) < 1e-12) {
        if (from.z < low || from.z > high) continue;
      } else {
        const a = (low - from.z) / ray.z, b = (high - from.z) / ray.z;
        s0 = Math.max(0, Math.min(a, b));
        s1 = Math.max(a, b);
      }
      const kept = stage.kept_part(from, ray, slab);
      const at_cut = kept[0] > s0;
      s0 = Math.max(s0, kept[0]);
      s1 = Math.min(s1, kept[1]);
      if (!(s0 < s1) || (best && s0 >= best.s)) continue;
      const hit = this.pierce(origin, [ray.x, ray.y], s0, Math.min(s1, 1e7), (t) => visibility.at(slab, t) >= 0);
      if (!hit || (best && hit.s >= best.s)) continue;
      const kind = hit.side >= 0 ? "wall" : at_cut ? "section" : ray.z < 0 ? "up" : "down";
      const c = this.corners;
      best = {
        s: hit.s, slab, t: hit.t, kind,
        a: hit.side >= 0 ? c[hit.side] : -1,
        b: hit.side >= 0 ? c[hit.side % 3 === 2 ? hit.side - 2 : hit.side + 1] : -1,
        at: [origin[0] + hit.s * ray.x, origin[1] + hit.s * ray.y, (from.z + hit.s * ray.z - stage.offset(slab)) / thickness + stage.centre[2]],
      };
    }
    return best;
  }
  /// All there is to know about a picked cell.
  describe(hit) {
    const { tables } = this;
    let sublayer = this.first_sublayer[hit.slab];
    while (sublayer + 1 < this.first_sublayer[hit.slab + 1] && hit.at[2] > this.z[sublayer + 1]) ++sublayer;
    const height = this.z[sublayer + 1] - this.z[sublayer];
    const group = tables.groups[this.group(hit.slab, hit.t)], material = tables.materials[group.material];
    const tag = hit.kind === "section" ? -1 : this.face_tag(hit.kind, hit.slab, hit.t, hit.a, hit.b);
    return {
      ...hit, sublayer, prism: this.cell_number(hit.slab, sublayer, hit.t), group: group.name, group_id: group.id,
      layer: tables.layers[group.layer].name, material: material.name, net: group.net < 0 ? "none" : tables.nets[group.net].name,
      face_tag: tag < 0 ? "none" : tables.face_tags[tag].name, face_tag_id: tag < 0 ? null : tables.face_tags[tag].id,
      q_p: this.prism_quality(hit.slab, hit.t, height), q_t: this.triangle_quality(hit.t), longest_mm: this.longest[hit.t], height_mm: height, eps_r: material.eps_r,
    };
  }
  /// The same for people: { title, rows: [name, value], spoken }.
  card(d) {
    const face = { up: "top face", down: "bottom face", wall: "side face", section: "cut" }[d.kind];
    return {
      title: `Prism ${grouped(d.prism)}`,
      rows: [
        ["Layer", d.layer], ["Material", `${d.material} (\u03b5r ${short(d.eps_r)})`], ["Net", d.net],
        ["Volume group", `${d.group_id}: ${d.group}`], [`Face tag, ${face}`, d.face_tag_id === null ? "none" : `${d.face_tag_id}: ${d.face_tag}`],
        ["Triangle, sub-layer", `${grouped(d.t)}, ${d.sublayer}`], ["q_p, q_t", `${short(d.q_p)}, ${short(d.q_t)}`],
        ["Longest edge, height", `${length_text(d.longest_mm)}, ${length_text(d.height_mm)}`],
      ],
      spoken: `Prism ${d.prism}, layer ${d.layer}, material ${d.material}, net ${d.net}, quality ${short(d.q_p)}`,
    };
  }
  /// Line segments around a described cell, on the stage.
  outline(d, stage) {
    const low = stage.lift(this.z[d.sublayer], d.slab), high = stage.lift(this.z[d.sublayer + 1], d.slab);
    const points = [];
    for (let i = 0; i < 3; ++i) {
      const a = this.corners[3 * d.t + i], b = this.corners[3 * d.t + ((i + 1) % 3)];
      const p = [this.x[a] - stage.centre[0], this.y[a] - stage.centre[1]], q = [this.x[b] - stage.centre[0], this.y[b] - stage.centre[1]];
      points.push(...p, low, ...q, low, ...p, high, ...q, high, ...p, low, ...p, high);
    }
    return points;
  }

  /// neighbour[3 t + i]: triangle across the side from corner i to corner i + 1, or -1.
  find_neighbours() {
    const { corners, num_points } = this;
    const num_sides = corners.length;
    const neighbour = (this.neighbour = new Int32Array(num_sides).fill(-1));
    const starts = new Int32Array(num_points + 1);
    const end_of = (side) => corners[side % 3 === 2 ? side - 2 : side + 1];
    for (let i = 0; i < num_sides; ++i) ++starts[Math.min(corners[i], end_of(i)) + 1];
    for (let v = 0; v < num_points; ++v) starts[v + 1] += starts[v];
    const next = starts.slice(0, num_points);
    const sides = new Int32Array(num_sides);
    for (let i = 0; i < num_sides; ++i) sides[next[Math.min(corners[i], end_of(i))]++] = i;
    for (let v = 0; v < num_points; ++v) {
      for (let p = starts[v]; p < starts[v + 1]; ++p) {
        const a = sides[p];
        if (neighbour[a] >= 0) continue;
        for (let q = p + 1; q < starts[v + 1]; ++q) {
          const b = sides[q];
          if (corners[a] !== end_of(b) || corners[b] !== end_of(a)) continue;
          neighbour[a] = (b / 3) | 0;
          neighbour[b] = (a / 3) | 0;
          break;
        }
      }
    }
    this.border = [];
    for (let i = 0; i < num_sides; ++i) if (neighbour[i] < 0) this.border.push(i);
  }

  measure() {
    const { corners, x, y } = this;
    const n = this.num_triangles;
    this.area = new Float64Array(n);
    this.beta = new Float64Array(n);
    this.longest = new Float64Array(n);
    let [min_x, min_y, max_x, max_y] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.num_points; ++i) {
      if (x[i] < min_x) min_x = x[i];
      if (x[i] > max_x) max_x = x[i];
      if (y[i] < min_y) min_y = y[i];
      if (y[i] > max_y) max_y = y[i];
    }
    this.box = { min_x, min_y, max_x, max_y };
    this.size_range = [Infinity, 0];
    for (let t = 0; t < n; ++t) {
      const a = corners[3 * t], b = corners[3 * t + 1], c = corners[3 * t + 2];
      const ux = x[b] - x[a], uy = y[b] - y[a], vx = x[c] - x[a], vy = y[c] - y[a], wx = vx - ux, wy = vy - uy;
      const u = ux * ux + uy * uy, v = vx * vx + vy * vy, w = wx * wx + wy * wy;
      this.area[t] = 0.5 * (ux * vy - uy * vx);
      this.beta[t] = u + v + w;
      const longest = (this.longest[t] = Math.sqrt(Math.max(u, v, w)));
      if (longest < this.size_range[0]) this.size_range[0] = longest;
      if (longest > this.size_range[1]) this.size_range[1] = longest;
    }
  }

  group(slab, t) {
    return this.groups[this.column[t] * this.num_slabs + slab];
  }
  num_cuts(slab) {
    return this.first_sublayer[slab + 1] - this.first_sublayer[slab];
  }
  height(slab) {
    return (this.slab_z[slab + 1] - this.slab_z[slab]) / this.num_cuts(slab);
  }
  /// Ye and Daniels, equations 1 and 2.
  triangle_quality(t) {
    return (4 * Math.sqrt(3) * this.area[t]) / this.beta[t];
  }
  prism_quality(slab, t, h = this.height(slab)) {
    return prism_quality(this.area[t], this.beta[t], h);
  }

  /// Number of a prism among the cells of every mesh file of the run, from 0 (mesh::MeshSource, PrismSource): group after group,
  /// in a group slab after slab, in a slab 512 triangles through all its sub-layers at a time.
  cell_number(slab, sublayer, t) {
    const at_once = 512, group = this.group(slab, t);
    let number = 0, rank = 0, total = 0;
    for (let s = 0; s < this.num_slabs; ++s) {
      const cuts = this.num_cuts(s);
      for (let u = 0; u < this.num_triangles; ++u) {
        const other = this.group(s, u);
        if (other < 0) continue;
        if (other < group || (other === group && s < slab)) number += cuts;
        if (other === group && s === slab) {
          ++total;
          if (u < t) ++rank;
        }
      }
    }
    const first = rank - (rank % at_once), size = Math.min(at_once, total - first);
    return number + first * this.num_cuts(slab) + (sublayer - this.first_sublayer[slab]) * size + (rank - first);
  }

  /// Face tag of a boundary face, or -1. kind: "up", "down" or "wall" (a -> b).
  face_tag(kind, slab, t, a, b) {
    if (kind === "wall") {
      const w = this.walls;
      for (let i = 0; i < w.tag.length; ++i)
        if (w.slab[i] === slab && ((w.a[i] === a && w.b[i] === b) || (w.a[i] === b && w.b[i] === a))) return w.tag[i];
      return -1;
    }
    // A hull face looks out of its cell; a face between two cells is listed as looking up.
    const level = this.first_sublayer[slab + (kind === "up" ? 1 : 0)], inner = this.tables.face_tags;
    const c = this.caps;
    for (let i = 0; i < c.tag.length; ++i)
      if (c.triangle[i] === t && c.place[i] >> 1 === level && (inner[c.tag[i]].inner || (c.place[i] & 1) === (kind === "up" ? 1 : 0))) return c.tag[i];
    return -1;
  }

  /// Triangle that holds a point, or -1.
  locate(px, py) {
    const { corners, x, y } = this;
    for (let t = 0; t < this.num_triangles; ++t) {
      let inside = true;
      for (let i = 0; i < 3 && inside; ++i) {
        const a = corners[3 * t + i], b = corners[3 * t + ((i + 1) % 3)];
        inside = (x[b] - x[a]) * (py - y[a]) - (y[b] - y[a]) * (px - x[a]) >= 0;
      }
      if (inside) return t;
    }
    return -1;
  }

  /// Where the line p + s d (in the plane) leaves triangle t after s: { s, side }.
  leave(t, p, d, s) {
    const { corners, x, y } = this;
    let out = { s: Infinity, side: -1 };
    for (let i = 0; i < 3; ++i) {
      const a = corners[3 * t + i], b = corners[3 * t + ((i + 1) % 3)];
      const nx = y[b] - y[a], ny = -(x[b] - x[a]); // outwards
      const speed = nx * d[0] + ny * d[1];
      if (speed <= 0) continue;
      const at = (nx * (x[a] - p[0]) + ny * (y[a] - p[1])) / speed;
      if (at < out.s) out = { s: at, side: 3 * t + i };
    }
    return { s: Math.max(out.s, s), side: out.side };
  }

  /// First border side that the line enters through in (from, to): { s, side }.
  enter(p, d, from, to) {
    const { corners, x, y } = this;
    let best = { s: to, side: -1 };
    for (const side of this.border) {
      const a = corners[side], b = corners[side % 3 === 2 ? side - 2 : side + 1];
      const ex = x[b] - x[a], ey = y[b] - y[a];
      const nx = ey, ny = -ex;
      const speed = nx * d[0] + ny * d[1];
      if (speed >= 0) continue;
      const s = (nx * (x[a] - p[0]) + ny * (y[a] - p[1])) / speed;
      if (s <= from || s >= best.s) continue;
      const along = ex * (p[0] + s * d[0] - x[a]) + ey * (p[1] + s * d[1] - y[a]);
      if (along >= 0 && along <= ex * ex + ey * ey) best = { s, side };
    }
    return best;
  }

  /// First shown cell along the ray inside one slab, for s in [from, to]: { s, t, side } or null. `is_shown(t)`.
  /// side = -1 where the ray is inside the cell from the start.
  pierce(origin, direction, from, to, is_shown) {
    const p = [origin[0], origin[1]], d = [direction[0], direction[1]];
    let s = from;
    let t = this.locate(p[0] + s * d[0], p[1] + s * d[1]);
    let side = -1;
    for (let guard = 0; guard < 2 * this.num_triangles + 10; ++guard) {
      if (t < 0) {
        const entry = this.enter(p, d, s, to);
        if (entry.side < 0) return null;
        s = entry.s;
        side = entry.side;
        t = (side / 3) | 0;
      }
      if (is_shown(t)) return { s, t, side };
      const exit = this.leave(t, p, d, s);
      if (exit.side < 0 || exit.s >= to) return null;
      s = exit.s;
      const next = this.neighbour[exit.side];
      side = -1;
      if (next >= 0)
        for (let i = 0; i < 3; ++i) if (this.neighbour[3 * next + i] === t) side = 3 * next + i;
      t = next;
    }
    return null;
  }
}
