// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh of cells as the page knows it: the faces that may be seen (hull, between volume groups, tagged) with what lies on
// either side of them. Lengths in millimetres. A storey is a band of groups that lie at the same height.
import { unzigzag } from "./decode.mjs";
import { blend, colour_at, light_on, no_value, rgb } from "./paint.mjs";
import { length_text, grouped, short } from "./panel.mjs";
import { prism_quality } from "./prisms.mjs";

// Vertices of a face as [corner, distances from the sides]. The diagonal of a quadrilateral is no edge: the corner opposite to it
// counts as far away.
const triangle_pattern = [[0, 255, 0, 0], [1, 0, 255, 0], [2, 0, 0, 255]];
const quad_pattern = [[0, 255, 255, 0], [1, 0, 255, 0], [2, 0, 255, 255], [0, 255, 255, 0], [2, 0, 255, 255], [3, 0, 255, 0]];

export class Cells {
  constructor(tables, arrays) {
    this.tables = tables;
    this.word = "cells";
    this.exact_section = false; // a cut shows groups: the page does not have the cells inside them
    const n = (this.num_faces = arrays.corner0.length);
    const [step, step_z] = tables.step_m;
    const axis = (values, k, by) => Float64Array.from(values, (v) => 1e3 * (tables.origin_m[k] + by * v));
    const at_place = (values) => Float64Array.from(arrays.place, (p) => values[p]);
    this.x = at_place(axis(arrays.x, 0, step));
    this.y = at_place(axis(arrays.y, 1, step));
    this.z = axis(arrays.z, 2, step_z);
    this.corners = new Int32Array(4 * n);
    for (let f = 0; f < n; ++f) {
      const a = (this.corners[4 * f] = arrays.corner0[f]), d = arrays.corner3[f];
      this.corners[4 * f + 1] = a + unzigzag(arrays.corner1[f]);
      this.corners[4 * f + 2] = a + unzigzag(arrays.corner2[f]);
      this.corners[4 * f + 3] = d === 0 ? -1 : a + unzigzag(d - 1);
    }
    Object.assign(this, { side: arrays.side, cell: arrays.cell, quality: arrays.quality });
    this.other = new Int32Array(n).fill(-1);
    this.other_quality = new Int32Array(n);
    for (let f = 0, k = 0; f < n; ++f) {
      if (tables.sides[this.side[f]][1] < 0) continue;
      this.other[f] = arrays.other[k];
      this.other_quality[f] = arrays.other_quality[k++];
    }
    this.num_storeys = tables.num_bands;
    this.measure();
  }
  measure() {
    const { x, y, z, num_faces } = this;
    let [min_x, min_y, max_x, max_y, low, high] = [Infinity, Infinity, -Infinity, -Infinity, Infinity, -Infinity];
    for (let i = 0; i < x.length; ++i) {
      min_x = Math.min(min_x, x[i]);
      max_x = Math.max(max_x, x[i]);
      min_y = Math.min(min_y, y[i]);
      max_y = Math.max(max_y, y[i]);
      low = Math.min(low, z[i]);
      high = Math.max(high, z[i]);
    }
    this.box = { min_x, min_y, max_x, max_y };
    this.z_range = [low, high];
    this.longest = new Float32Array(num_faces);
    this.size_range = [Infinity, 0];
    for (let f = 0; f < num_faces; ++f) {
      const c = this.corners_of(f);
      let longest = 0;
      c.forEach((a, i) => {
        const b = c[(i + 1) % c.length];
        longest = Math.max(longest, Math.hypot(x[a] - x[b], y[a] - y[b], z[a] - z[b]));
      });
      this.longest[f] = longest;
      if (longest < this.size_range[0]) this.size_range[0] = longest;
      if (longest > this.size_range[1]) this.size_range[1] = longest;
    }
  }
  corners_of(f) {
    const c = this.corners;
    return c[4 * f + 3] < 0 ? [c[4 * f], c[4 * f + 1], c[4 * f + 2]] : [c[4 * f], c[4 * f + 1], c[4 * f + 2], c[4 * f + 3]];
  }
  /// Quality of the cell before (0) or behind (1) a face; undefined: no measure.
  quality_of(f, which) {
    const n = which === 0 ? this.quality[f] : this.other_quality[f];
    if (n < 65536) return n === 0 ? undefined : (n - 1) * this.tables.quality_step;
    // A right prism over this triangle.
    const [a, b, c] = this.corners_of(f), side = (p, q) => Math.hypot(this.x[p] - this.x[q], this.y[p] - this.y[q], this.z[p] - this.z[q]);
    return prism_quality(Math.hypot(...this.cross(f)) / 2, side(a, b) ** 2 + side(b, c) ** 2 + side(c, a) ** 2, 1e3 * this.tables.heights_m[n - 65536]);
  }
  /// Twice the area of a face's first triangle, along its normal.
  cross(f) {
    const { x, y, z } = this, [a, b, c] = this.corners_of(f);
    const u = [x[b] - x[a], y[b] - y[a], z[b] - z[a]], v = [x[c] - x[a], y[c] - y[a], z[c] - z[a]];
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  }
  normal(f) {
    const n = this.cross(f), length = Math.hypot(...n) || 1;
    return n.map((w) => w / length);
  }

  // ---- drawing

  visibility(hidden, is_exploded) {
    const { groups } = this.tables;
    const shown = groups.map((g, i) => !hidden[i] && g.cells > 0);
    const rank = new Int32Array(this.num_storeys);
    let next = 0;
    for (let band = 0; band < this.num_storeys; ++band) {
      rank[band] = Math.max(0, next - 1);
      if (groups.some((g, i) => shown[i] && g.band === band)) rank[band] = next++;
    }
    return { shown, rank, num_ranks: Math.max(1, next), is_exploded };
  }
  paint(mode) {
    return new CellPaint(this, mode);
  }
  /// Surfaces that stand in the place of a face: as [owner's, neighbour's, one between two shown groups] flags. The last
  /// matters to a section alone.
  surfaces(f, visibility, has_plane) {
    const [group, other] = this.tables.sides[this.side[f]], { groups } = this.tables;
    const here = visibility.shown[group], there = other >= 0 && visibility.shown[other];
    if (!here || !there) return [here, there, false];
    if (visibility.is_exploded && groups[group].band !== groups[other].band) return [true, true, false];
    return [false, false, has_plane && group !== other];
  }
  /// Vertex arrays as of skin.mjs, and `back`: what is seen from the other side, the cut.
  build(visibility, paint, centre, has_plane) {
    const { num_faces, x, y, z, tables, box } = this;
    const per_side = num_faces > 20000 ? 8 : 1, num_tiles = per_side * per_side;
    const tile_of = (f) => {
      const v = this.corners[4 * f];
      const i = Math.min(per_side - 1, (per_side * (x[v] - box.min_x)) / (box.max_x - box.min_x)) | 0;
      return (Math.min(per_side - 1, (per_side * (y[v] - box.min_y)) / (box.max_y - box.min_y)) | 0) * per_side + i;
    };
    const counts = new Int32Array(num_tiles), surfaces = new Uint8Array(num_faces);
    let num_surfaces = 0;
    for (let f = 0; f < num_faces; ++f) {
      const [own, other, between] = this.surfaces(f, visibility, has_plane);
      surfaces[f] = (own ? 1 : 0) | (other ? 2 : 0) | (between ? 4 : 0);
      const times = own + other + between;
      num_surfaces += times;
      counts[tile_of(f)] += times * (this.corners[4 * f + 3] < 0 ? 3 : 6);
    }
    const ranges = [], next = new Int32Array(num_tiles);
    let num_vertices = 0;
    for (let tile = 0; tile < num_tiles; ++tile) {
      next[tile] = num_vertices;
      if (counts[tile] > 0) ranges.push({ kind: "any", tile, start: num_vertices, count: counts[tile] });
      num_vertices += counts[tile];
    }
    const position = new Float32Array(3 * num_vertices), colour = new Uint8Array(4 * num_vertices);
    const corner = new Uint8Array(4 * num_vertices), back = new Uint8Array(4 * num_vertices);
    for (let f = 0; f < num_faces; ++f) {
      if (surfaces[f] === 0) continue;
      const tile = tile_of(f), [group, other] = tables.sides[this.side[f]], normal = this.normal(f);
      const quad = this.corners[4 * f + 3] >= 0, size = quad ? 4 : 3;
      for (let which = 0; which < 3; ++which) {
        if (!(surfaces[f] & (1 << which))) continue;
        // Front: what is seen from the side the corners run counter-clockwise on.
        const turned = which === 1, own = turned ? other : group;
        const light = which === 2 ? 1 : turned ? light_on(-normal[0], -normal[1], -normal[2]) : light_on(normal[0], normal[1], normal[2]);
        const front = which === 2 ? paint.cut(other) : paint.face(f, which), inside = paint.cut(own);
        const lit = which === 2 ? 0 : 255, rank = Math.min(255, visibility.rank[tables.groups[own].band]);
        let n = next[tile];
        const pattern = quad ? quad_pattern : triangle_pattern;
        for (const [k, e0, e1, e2] of pattern) {
          const v = this.corners[4 * f + (turned ? size - 1 - k : k)];
          position[3 * n] = x[v] - centre[0];
          position[3 * n + 1] = y[v] - centre[1];
          position[3 * n + 2] = z[v] - centre[2];
          const i = 4 * n;
          colour[i] = front[0] * light;
          colour[i + 1] = front[1] * light;
          colour[i + 2] = front[2] * light;
          colour[i + 3] = lit;
          back[i] = inside[0];
          back[i + 1] = inside[1];
          back[i + 2] = inside[2];
          back[i + 3] = 255;
          corner[i] = e0;
          corner[i + 1] = e1;
          corner[i + 2] = e2;
          corner[i + 3] = rank;
          ++n;
        }
        next[tile] = n;
      }
    }
    return { position, colour, corner, back, ranges, num_faces: num_surfaces, num_vertices, per_side };
  }
  /// What lies inside a solid that a section opens would shine through the cut: such faces are left out.
  build_tagged(visibility, wanted, colours, centre, has_plane) {
    const { x, y, z, tables } = this;
    const position = [], colour = [], corner = [];
    for (let f = 0; f < this.num_faces; ++f) {
      const [group, other, tag] = tables.sides[this.side[f]];
      if (tag < 0 || !wanted[tag] || (has_plane && other >= 0 && visibility.shown[group] && visibility.shown[other])) continue;
      const storey = tables.groups[visibility.shown[group] || other < 0 ? group : other].band, rank = Math.min(255, visibility.rank[storey]);
      const c = this.corners_of(f), normal = this.normal(f), light = light_on(normal[0], normal[1], Math.abs(normal[2]));
      for (const [k, e0, e1, e2] of c.length === 4 ? quad_pattern : triangle_pattern) {
        position.push(x[c[k]] - centre[0], y[c[k]] - centre[1], z[c[k]] - centre[2]);
        colour.push(...colours[tag].map((w) => w * light), 255);
        corner.push(e0, e1, e2, rank);
      }
    }
    return { position: new Float32Array(position), colour: new Uint8Array(colour), corner: new Uint8Array(corner) };
  }
  guess_triangles() {
    return 2 * this.num_faces;
  }
  extent(visibility) {
    const { tables } = this;
    const storeys = [];
    tables.groups.forEach((g, i) => visibility.shown[i] && storeys.push({ storey: g.band, low: 1e3 * g.z_m[0], high: 1e3 * g.z_m[1] }));
    let [min_x, min_y, max_x, max_y] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let f = 0; f < this.num_faces; ++f) {
      const [own, other] = this.surfaces(f, visibility, false);
      if (!own && !other) continue;
      for (const v of this.corners_of(f)) {
        min_x = Math.min(min_x, this.x[v]);
        max_x = Math.max(max_x, this.x[v]);
        min_y = Math.min(min_y, this.y[v]);
        max_y = Math.max(max_y, this.y[v]);
      }
    }
    return { storeys, ...(min_x > max_x ? this.box : { min_x, min_y, max_x, max_y }) };
  }
  shown_height(hidden) {
    let low = Infinity, high = -Infinity;
    this.tables.groups.forEach((g, i) => {
      if (hidden[i] || g.cells === 0) return;
      low = Math.min(low, 1e3 * g.z_m[0]);
      high = Math.max(high, 1e3 * g.z_m[1]);
    });
    return low < high ? high - low : 0;
  }

  // ---- places

  storey_at(z) {
    for (const g of this.tables.groups) if (g.cells > 0 && z >= 1e3 * g.z_m[0] && z <= 1e3 * g.z_m[1]) return g.band;
    return 0;
  }
  /// The nearest face tells how large cells are there. A place inside a group has no cell in the page.
  look_up(at) {
    let best = Infinity, size = null;
    for (let f = 0; f < this.num_faces; ++f) {
      const v = this.corners[4 * f], far = (this.x[v] - at[0]) ** 2 + (this.y[v] - at[1]) ** 2 + (this.z[v] - at[2]) ** 2;
      if (far >= best) continue;
      best = far;
      size = this.longest[f];
    }
    return { size, hit: null };
  }
  size_of(hit) {
    return this.longest[hit.face];
  }
  group_of(hit) {
    return hit.group;
  }
  /// First shown surface under a ray of the stage: { s, face, kind: "face" | "section", group, cell, at } or null.
  pick(stage, from, ray) {
    const { x, y, z, tables } = this, { visibility, centre } = stage, thickness = stage.uniforms.thickness.value;
    const ranks = new Map();
    const ray_in = (band) => {
      if (!ranks.has(band)) {
        const [s0, s1] = stage.kept_part(from, ray, band);
        ranks.set(band, {
          o: [from.x + centre[0], from.y + centre[1], (from.z - stage.offset(band)) / thickness + centre[2]],
          d: [ray.x, ray.y, ray.z / thickness], s0, s1,
        });
      }
      return ranks.get(band);
    };
    const meet = ({ o, d }, a, b, c) => {
      const e = [x[b] - x[a], y[b] - y[a], z[b] - z[a]], g = [x[c] - x[a], y[c] - y[a], z[c] - z[a]];
      const p = [d[1] * g[2] - d[2] * g[1], d[2] * g[0] - d[0] * g[2], d[0] * g[1] - d[1] * g[0]];
      const det = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
      if (det === 0) return null;
      const t = [o[0] - x[a], o[1] - y[a], o[2] - z[a]], u = (t[0] * p[0] + t[1] * p[1] + t[2] * p[2]) / det;
      if (u < 0 || u > 1) return null;
      const q = [t[1] * e[2] - t[2] * e[1], t[2] * e[0] - t[0] * e[2], t[0] * e[1] - t[1] * e[0]];
      const v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
      return v < 0 || u + v > 1 ? null : { s: (g[0] * q[0] + g[1] * q[1] + g[2] * q[2]) / det, from_outside: det > 0 };
    };
    let best = null;
    for (let f = 0; f < this.num_faces; ++f) {
      const flags = this.surfaces(f, visibility, Boolean(stage.plane));
      if (!flags[0] && !flags[1] && !flags[2]) continue;
      const [group, other] = tables.sides[this.side[f]], c = this.corners_of(f);
      for (const which of [0, 1, 2]) {
        if (!flags[which]) continue;
        const own = which === 1 ? other : group, r = ray_in(tables.groups[own].band);
        const hit = meet(r, c[0], c[1], c[2]) ?? (c.length === 4 ? meet(r, c[0], c[2], c[3]) : null);
        if (!hit || hit.s < r.s0 || hit.s > r.s1 || (best && hit.s >= best.s)) continue;
        // Where the ray came from tells what is seen: a cell's face, or the cut through a group.
        const before = hit.from_outside ? other : group, behind = hit.from_outside ? group : other;
        const is_cut = which === 2 || (hit.from_outside ? which === 1 : which === 0);
        const s = is_cut ? r.s0 : hit.s;
        best = {
          s: hit.s, face: f, kind: is_cut ? "section" : "face", group: is_cut ? before : behind,
          which: hit.from_outside ? 0 : 1, cell: is_cut ? -1 : hit.from_outside ? this.cell[f] : this.other[f],
          slab: tables.groups[own].band, at: r.o.map((v, k) => v + s * r.d[k]),
        };
      }
    }
    return best;
  }
  describe(hit) {
    const { tables } = this;
    const group = tables.groups[hit.group], tag = hit.kind === "section" ? -1 : tables.sides[this.side[hit.face]][2];
    const name = (table, i) => (i < 0 ? "none" : table[i].name);
    return {
      ...hit, group: group.name, group_id: group.id, layer: name(tables.layers, group.layer), material: name(tables.materials, group.material),
      net: name(tables.nets, group.net), face_tag: tag < 0 ? "none" : tables.face_tags[tag].name, face_tag_id: tag < 0 ? null : tables.face_tags[tag].id,
      quality: hit.kind === "section" ? undefined : this.quality_of(hit.face, hit.which), longest_mm: this.longest[hit.face],
    };
  }
  card(d) {
    const is_cut = d.kind === "section", known = this.tables.materials.length > 0;
    const rows = known ? [["Layer", d.layer], ["Material", d.material], ["Net", d.net]] : [];
    rows.push(["Volume group", `${d.group_id}: ${d.group}`]);
    if (!is_cut)
      rows.push(["Face tag", d.face_tag_id === null ? "none" : `${d.face_tag_id}: ${d.face_tag}`], ["Quality", d.quality === undefined ? "no measure" : short(d.quality)],
        ["Longest edge of the face", length_text(d.longest_mm)]);
    return {
      title: is_cut ? "Cut through a group" : `Cell ${grouped(d.cell)}`, rows,
      spoken: is_cut ? `Cut through ${d.group}` : `Cell ${d.cell}, group ${d.group}, quality ${d.quality === undefined ? "unknown" : short(d.quality)}`,
    };
  }
  outline(d, stage) {
    const c = this.corners_of(d.face), points = [];
    const at = (v) => [this.x[v] - stage.centre[0], this.y[v] - stage.centre[1], stage.lift(this.z[v], d.slab)];
    if (d.kind !== "section") c.forEach((v, i) => points.push(...at(v), ...at(c[(i + 1) % c.length])));
    return points;
  }
  /// Middle of the faces of a tag, mm, or null.
  middle_of_tag(tag) {
    const sum = [0, 0, 0];
    let count = 0;
    for (let f = 0; f < this.num_faces; ++f) {
      if (this.tables.sides[this.side[f]][2] !== tag) continue;
      const v = this.corners[4 * f];
      sum[0] += this.x[v];
      sum[1] += this.y[v];
      sum[2] += this.z[v];
      ++count;
    }
    return count === 0 ? null : sum.map((s) => s / count);
  }
}

/// Colours of faces, as src/view/cell_paint.cpp chooses them.
class CellPaint {
  constructor(cells, mode) {
    const { tables } = cells;
    Object.assign(this, { cells, mode });
    this.ramp = tables.ramp.map(rgb);
    this.kinds = tables.groups.map((g) => (g.material < 0 ? "" : tables.materials[g.material].kind));
    this.groups = tables.groups.map((g) => {
      if (mode === "net") return rgb(g.net_colour);
      if (mode === "layer" && g.layer >= 0) return rgb(tables.layers[g.layer].colour);
      return rgb(mode === "group" || g.material < 0 ? g.colour : tables.materials[g.material].colour);
    });
    this.tags = tables.face_tags.map((tag) => rgb(tag.colour));
    this.range = mode === "size" ? cells.size_range : [0, 1];
  }
  /// What a section shows of a group: its colour, or none where colours belong to cells.
  cut(group) {
    return this.mode === "q_p" || this.mode === "size" || this.mode === "tag" ? no_value : this.groups[group];
  }
  /// which: 0 = the cell the face belongs to, 1 = the one on the other side.
  face(f, which) {
    const { cells } = this;
    if (this.mode === "q_p") {
      const q = cells.quality_of(f, which);
      return q === undefined ? no_value : colour_at(this.ramp, q);
    }
    if (this.mode === "size") {
      const [low, high] = this.range;
      return colour_at(this.ramp, high > low ? Math.log(cells.longest[f] / low) / Math.log(high / low) : 0.5);
    }
    const [group, other, tag, film, other_film] = cells.tables.sides[cells.side[f]];
    if (this.mode === "tag") return tag < 0 ? no_value : this.tags[tag];
    const own = this.groups[which === 0 ? group : other], behind = which === 0 ? film : other_film;
    return behind < 0 || Math.abs(cells.normal(f)[2]) < 0.99 ? own : blend(own, this.groups[behind], this.mode === "net" ? 0.75 : 0.5);
  }
}
